#include "geometry/mesh_pieces.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/polygon_triangles.h"

namespace robot_tissue {
namespace {

// Spacings (1): so near a plane a vertex is on it. More: what is thinner vanishes; less: edges of
// no length, which have no direction. Chosen.
constexpr double kOnPlane = 1e-6;
// Spacings (1) that the search for a point on a bent plane may be off it, and its steps. Rounding.
constexpr double kFound = 1e-13;
constexpr int kMostSteps = 60;
// Points along an edge at which bent planes are looked for, and rounds of that. More: finer turns
// are found; less: tips of a wound stand out of the skin. Chosen.
constexpr int kSamples = 7;
constexpr int kMostTurns = 2;
// Barycentric (1): a bend is so far inside a triangle at least. Less: slivers. Chosen.
constexpr double kInside = 1e-6;

// Half spacings along the two next axes, from the middle of a bent plane to where it bends.
constexpr std::array<std::pair<int, int>, 8> kAround = {
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

int next(int axis) { return (axis + 1) % 3; }
int afterNext(int axis) { return (axis + 2) % 3; }

int lowOfCell(int octant) { return octant - octant % 2; }

Vec3 ontoPlanes(Vec3 point) {
  for (double& along : point) {
    const double nearest = 0.5 * std::round(2.0 * along);
    if (std::abs(along - nearest) < kOnPlane) along = nearest;
  }
  return point;
}

std::array<int, 4> seamOf(const HalfIndex& octant, int axis) {
  return {octant[0], octant[1], octant[2], axis};
}

}  // namespace

MeshPieces::MeshPieces(std::vector<Vec3> vertices, const std::array<int, 3>& cells,
                       const BentGrid& grid)
    : grid_(grid), places_(std::move(vertices)) {
  vertices_.reserve(places_.size());
  for (const Vec3& place : places_) vertices_.push_back(ontoPlanes(grid_.straightened(place)));
  for (std::size_t axis = 0; axis < 3; ++axis) octants_[axis] = 2 * cells[axis];
}

void MeshPieces::add(const MeshTriangle& triangle, int number, bool keep_pieces) {
  triangle_ = number;
  cutAtNodes(0, {{triangle[0], -1}, {triangle[1], -1}, {triangle[2], -1}}, keep_pieces);
}

int MeshPieces::addVertex(const Vec3& straight, const Vec3& place) {
  vertices_.push_back(straight);
  places_.push_back(place);
  return static_cast<int>(vertices_.size()) - 1;
}

int MeshPieces::addMiddle(const std::vector<int>& points) {
  Vec3 straight = Vec3::Zero(), place = Vec3::Zero();
  for (const int point : points) {
    straight += vertices_[at(point)];
    place += places_[at(point)];
  }
  const auto count = static_cast<double>(points.size());
  return addVertex(straight / count, place / count);
}

// The border planes of the grid cut nothing: what stands out there belongs to the octants inside.
HalfIndex MeshPieces::octantOf(const Vec3& point) const {
  HalfIndex octant{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = std::floor(2.0 * point[static_cast<Eigen::Index>(axis)]);
    octant[axis] = std::clamp(static_cast<int>(half), 0, octants_[axis] - 1);
  }
  return octant;
}

// Whether the vertex is above the plane; on it counts as above.
bool MeshPieces::isAbove(int vertex, int axis, int plane) const {
  return vertices_[at(vertex)][axis] >= 0.5 * plane;
}

// How far along the edge it meets the plane, of its length (1). Planes of nodes are straight; a
// bent plane is found by false position (Illinois: Dowell and Jarratt 1971).
double MeshPieces::alongEdge(int from, int to, int axis, int plane) const {
  const double height = 0.5 * plane;
  const Vec3 &a = places_[at(from)], &b = places_[at(to)];
  if (plane % 2 == 0) return (height - a[axis]) / (b[axis] - a[axis]);
  double low = 0.0, high = 1.0;
  double at_low = vertices_[at(from)][axis] - height, at_high = vertices_[at(to)][axis] - height;
  double along = at_low / (at_low - at_high);
  for (int step = 0; step < kMostSteps; ++step) {
    const double above = grid_.straightened(a + along * (b - a))[axis] - height;
    if (std::abs(above) < kFound) break;
    const bool is_low = (above < 0.0) == (at_low < 0.0);
    (is_low ? low : high) = along;
    (is_low ? at_low : at_high) = above;
    (is_low ? at_high : at_low) *= 0.5;
    along = low + at_low / (at_low - at_high) * (high - low);
  }
  return along;
}

// An end that is on the plane is the point. Else it is in the cell that the edge is in, and along
// the axes that it has been cut along already in the same octant.
int MeshPieces::crossing(int from, int to, int axis, int plane) {
  for (const int end : {from, to}) {
    if (vertices_[at(end)][axis] == 0.5 * plane) return end;
  }
  const auto [low, high] = std::minmax(from, to);
  const auto [known, is_new] =
      crossings_.try_emplace(std::array<int, 4>{low, high, axis, plane}, 0);
  if (!is_new) return known->second;
  const Vec3 a = places_[at(low)], b = places_[at(high)];
  Vec3 place = a + alongEdge(low, high, axis, plane) * (b - a);
  place = place.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
  const bool at_nodes = plane % 2 == 0;
  if (at_nodes) place[axis] = 0.5 * plane;
  Vec3 straight = ontoPlanes(grid_.straightened(place));
  for (int other = 0; other < 3; ++other) {
    const double at_low = vertices_[at(low)][other], at_high = vertices_[at(high)][other];
    const double start = std::min(at_low, at_high);
    if (at_low == at_high) {
      straight[other] = start;  // in a plane
    } else if (other < axis || !at_nodes) {
      const double step = at_nodes || other > axis ? 1.0 : 0.5;
      const double first = step * std::floor(start / step);
      straight[other] = std::clamp(straight[other], first, std::nextafter(first + step, 0.0));
    }
  }
  straight[axis] = 0.5 * plane;
  known->second = addVertex(straight, place);
  return known->second;
}

// Along an edge in one cell a bent plane may come and go again. Where it does, a point between; in
// order, from the lower number to the higher one.
std::vector<int> MeshPieces::findTurns(int low, int high, int cut) {
  std::array<Vec3, kSamples> straight;
  for (int i = 0; i < kSamples; ++i) {
    straight[at(i)] = straightBetween(low, high, cut, (i + 1.0) / (kSamples + 1.0));
  }
  std::array<bool, kSamples> is_turn{};
  for (int axis = cut; axis < 3; ++axis) {
    const double start = vertices_[at(low)][axis], end = vertices_[at(high)][axis];
    const double plane = std::floor(std::min(start, end)) + 0.5;
    if (start == end && start == plane - 0.5) continue;  // in a plane of nodes
    int farthest = -1;  // of those since the plane was crossed, the first run left out
    bool is_above = start >= plane;
    for (int i = 0; i <= kSamples; ++i) {
      const double here = (i < kSamples ? straight[at(i)][axis] : end) - plane;
      if ((here >= 0.0) != is_above) {
        if (farthest >= 0) is_turn[at(farthest)] = true;
        is_above = !is_above;
        farthest = i < kSamples ? i : -1;
      } else if (farthest >= 0 && i < kSamples &&
                 std::abs(here) > std::abs(straight[at(farthest)][axis] - plane)) {
        farthest = i;
      }
    }
  }
  std::vector<int> turns;
  for (int i = 0; i < kSamples; ++i) {
    if (!is_turn[at(i)]) continue;
    const double share = (i + 1.0) / (kSamples + 1.0);
    const Vec3& from = places_[at(low)];
    turns.push_back(addVertex(straight[at(i)], from + share * (places_[at(high)] - from)));
  }
  return turns;
}

// Of a point on an edge that is in one cell, and stays there, and in one octant along the axes that
// it has been cut along.
Vec3 MeshPieces::straightBetween(int low, int high, int cut, double share) const {
  const Vec3 &from = places_[at(low)], &to = places_[at(high)];
  Vec3 straight = ontoPlanes(grid_.straightened(from + share * (to - from)));
  for (int axis = 0; axis < 3; ++axis) {
    const double start = vertices_[at(low)][axis], end = vertices_[at(high)][axis];
    const double step = axis < cut ? 0.5 : 1.0, first = step * std::floor(std::min(start, end) / step);
    straight[axis] = start == end && start == first
                         ? start
                         : std::clamp(straight[axis], first, std::nextafter(first + step, 0.0));
  }
  return straight;
}

std::vector<int> MeshPieces::turns(int from, int to, int cut) {
  const auto [low, high] = std::minmax(from, to);
  const auto [known, is_new] = turns_.try_emplace(std::array<int, 3>{low, high, cut});
  if (is_new) known->second = findTurns(low, high, cut);
  std::vector<int> turns = known->second;
  if (from == high) std::reverse(turns.begin(), turns.end());
  return turns;
}

// In order. From below to above, as the pieces are cut, so that the points are the same.
std::vector<int> MeshPieces::crossingsBetween(int from, int to, int axis, bool at_nodes) {
  const int start = octantOf(vertices_[at(from)])[at(axis)];
  const int end = octantOf(vertices_[at(to)])[at(axis)];
  int lower = start < end ? from : to;
  const int upper = start < end ? to : from;
  std::vector<int> between;
  for (int plane = std::min(start, end) + 1; plane <= std::max(start, end); ++plane) {
    if ((plane % 2 == 0) != at_nodes) continue;
    const int point = crossing(lower, upper, axis, plane);
    if (point == upper || point == lower) continue;
    between.push_back(lower = point);
  }
  if (start > end) std::reverse(between.begin(), between.end());
  return between;
}

std::vector<int> MeshPieces::subdivided(int from, int to) {
  std::vector<int> points = {from, to};
  const auto refine = [&](const auto& between) {
    std::vector<int> finer = {points.front()};
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      for (const int point : between(points[i], points[i + 1])) finer.push_back(point);
      finer.push_back(points[i + 1]);
    }
    points.swap(finer);
  };
  for (int axis = 0; axis < 3; ++axis) {
    refine([&](int a, int b) { return crossingsBetween(a, b, axis, true); });
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int round = 0; round < kMostTurns; ++round) {
      refine([&](int a, int b) { return isBeside(a, b) ? turns(a, b, axis) : std::vector<int>(); });
    }
    refine([&](int a, int b) { return crossingsBetween(a, b, axis, false); });
  }
  return points;
}

// The edge, which is in one cell or between some, is in one that is bent, or beside it.
bool MeshPieces::isBeside(int from, int to) const {
  const Vec3 low = vertices_[at(from)].cwiseMin(vertices_[at(to)]);
  for (int around = 0; around < 8; ++around) {
    HalfIndex octant{};
    bool is_around = true;
    for (int axis = 0; axis < 3; ++axis) {
      const bool below = (around >> axis & 1) != 0;
      const double first = std::floor(low[axis]);
      const bool is_in_plane = vertices_[at(from)][axis] == first && vertices_[at(to)][axis] == first;
      is_around = is_around && (!below || is_in_plane);
      octant[at(axis)] = 2 * static_cast<int>(first) - (below ? 2 : 0);
    }
    if (is_around && grid_.isBent(octant)) return true;
  }
  return false;
}

void MeshPieces::split(const Polygon& triangle, int axis, int plane, Polygon& below,
                       Polygon& above) {
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    const Corner& from = triangle[i];
    const Corner& to = triangle[(i + 1) % triangle.size()];
    const bool starts_above = isAbove(from.vertex, axis, plane);
    (starts_above ? above : below).push_back(from);
    if (starts_above == isAbove(to.vertex, axis, plane)) continue;
    const int cut = crossing(from.vertex, to.vertex, axis, plane);
    noteCrossing(from, axis, plane, cut);
    // One part goes on along the plane, the other along the edge.
    (starts_above ? above : below).push_back({cut, 2 * axis + (starts_above ? 0 : 1)});
    (starts_above ? below : above).push_back({cut, from.face});
  }
}

// An edge in the upper face of a piece's octant, across `plane`: the point is on a line of the
// grid. Seen from above the face, the mesh encloses what is on the right of the edge.
void MeshPieces::noteCrossing(const Corner& from, int axis, int plane, int vertex) {
  if (from.face < 0 || from.face % 2 == 0) return;
  const int across = from.face / 2;
  const int along = 3 - across - axis;
  const int turn = next(across) == axis ? 1 : -1;
  const int rise = isAbove(from.vertex, axis, plane) ? 1 : -1;
  HalfIndex planes{};
  planes[at(axis)] = plane;
  planes[at(across)] = static_cast<int>(std::lround(2.0 * vertices_[at(vertex)][across]));
  const double place = vertices_[at(vertex)][along];
  const int octant = std::clamp(octantOf(vertices_[at(vertex)])[at(along)], first_[at(along)],
                                last_[at(along)]);  // the edge's
  lines_[{along, planes[at(next(along))], planes[at(afterNext(along))]}].push_back(
      {place, vertex, octant, turn * rise});
}

// Where the lines along which the facets of the bent plane meet pass through the triangle, in the
// order from one vertex to the other.
std::vector<int> MeshPieces::bendsBetween(int from, int to, const Polygon& triangle, int axis) {
  const HalfIndex middle = {lowOfCell(first_[0]) + 1, lowOfCell(first_[1]) + 1,
                            lowOfCell(first_[2]) + 1};
  const Vec3 &a = places_[at(triangle[0].vertex)], &b = places_[at(triangle[1].vertex)],
             &c = places_[at(triangle[2].vertex)];
  const Vec3 area = normalOf(triangle);
  const Vec3 start = grid_.placeOf(middle);
  const Vec3 along = places_[at(to)] - places_[at(from)];
  std::vector<std::pair<double, int>> bends;
  for (const auto& [u, v] : kAround) {
    HalfIndex point = middle;
    point[at(next(axis))] += u;
    point[at(afterNext(axis))] += v;
    const Vec3 end = grid_.placeOf(point);
    const double above_start = area.dot(start - a), above_end = area.dot(end - a);
    if (above_start * above_end >= 0.0) continue;
    const double share = above_start / (above_start - above_end);
    const Vec3 place = start + share * (end - start);
    const double least =
        std::min({area.dot((b - a).cross(place - a)), area.dot((c - b).cross(place - b)),
                  area.dot((a - c).cross(place - c))});
    const Vec3 from_start = place - places_[at(from)];
    const bool is_straight = along.cross(from_start).norm() < kOnPlane * along.norm();
    if (is_straight || !(least > kInside * area.squaredNorm())) continue;
    Vec3 straight = 0.5 * Vec3(middle[0], middle[1], middle[2]);
    straight[next(axis)] += 0.5 * share * u;
    straight[afterNext(axis)] += 0.5 * share * v;
    bends.emplace_back(along.dot(place), addVertex(straight, place));
  }
  std::sort(bends.begin(), bends.end());
  std::vector<int> vertices;
  for (const auto& [way, vertex] : bends) vertices.push_back(vertex);
  return vertices;
}

// Both parts of a triangle that a plane has cut from edge to edge follow its bends.
void MeshPieces::bend(const Polygon& triangle, int axis, Polygon& below, Polygon& above) {
  if (!grid_.isBent(first_)) return;
  const int seam = 2 * axis + 1;
  const auto is_seam = [&](const Corner& corner) { return corner.face == seam; };
  const auto start = std::find_if(below.begin(), below.end(), is_seam);
  const auto back = std::find_if(above.begin(), above.end(),
                                 [&](const Corner& corner) { return corner.face == seam - 1; });
  if (start == below.end() || back == above.end()) return;
  const auto bends = bendsBetween(start->vertex, back->vertex, triangle, axis);
  if (bends.empty()) return;
  Polygon bent_below = below, bent_above = above;
  std::vector<Corner> forwards, backwards;
  for (const int vertex : bends) forwards.push_back({vertex, seam});
  for (auto vertex = bends.rbegin(); vertex != bends.rend(); ++vertex) {
    backwards.push_back({*vertex, seam - 1});
  }
  bent_below.insert(bent_below.begin() + (start - below.begin()) + 1, forwards.begin(),
                    forwards.end());
  bent_above.insert(bent_above.begin() + (back - above.begin()) + 1, backwards.begin(),
                    backwards.end());
  const Vec3 normal = normalOf(triangle);
  if (fillOf(bent_below, normal).empty() || fillOf(bent_above, normal).empty()) return;
  below.swap(bent_below);
  above.swap(bent_above);
}

// Of a triangle's polygon: turned as that is.
std::vector<MeshTriangle> MeshPieces::fillOf(const Polygon& polygon, const Vec3& normal) const {
  std::vector<Vec3> places;
  for (const Corner& corner : polygon) places.push_back(places_[at(corner.vertex)]);
  return polygonTriangles(places, normal).triangles;
}

Vec3 MeshPieces::normalOf(const Polygon& triangle) const {
  const Vec3& first = places_[at(triangle[0].vertex)];
  return (places_[at(triangle[1].vertex)] - first).cross(places_[at(triangle[2].vertex)] - first);
}

std::vector<MeshPieces::Polygon> MeshPieces::trianglesOf(const Polygon& polygon,
                                                         const Vec3& normal) const {
  const auto count = static_cast<int>(polygon.size());
  std::vector<MeshTriangle> fill;
  if (count > 3) fill = fillOf(polygon, normal);
  if (fill.empty()) {  // one, or by rounding not a simple polygon
    for (int i = 1; i + 1 < count; ++i) fill.push_back({0, i, i + 1});
  }
  std::vector<Polygon> triangles;
  for (const MeshTriangle& each : fill) {
    Polygon& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& corner = polygon[at(each[i])];
      const bool is_side = (each[i] + 1) % count == each[(i + 1) % 3];
      triangle.push_back({corner.vertex, is_side ? corner.face : -1});
    }
  }
  return triangles;
}

void MeshPieces::keepWithin(int axis, int first, int last) {
  first_[at(axis)] = first;
  last_[at(axis)] = last;
}

void MeshPieces::keepWithinCell(int axis) {
  const int low = lowOfCell(first_[at(axis)]);
  keepWithin(axis, low, low + 1);
}

void MeshPieces::cutAtNodes(int axis, const Polygon& triangle, bool keep) {
  for (int each = 0; each < 3; ++each) {
    if (each < axis) {
      keepWithinCell(each);
    } else {
      keepWithin(each, 0, octants_[at(each)] - 1);
    }
  }
  if (axis == 3) return cutInCell(0, triangle, kMostTurns, keep);
  int first = octants_[at(axis)];
  int last = 0;
  for (const Corner& corner : triangle) {
    const int octant = octantOf(vertices_[at(corner.vertex)])[at(axis)];
    first = std::min(first, octant);
    last = std::max(last, octant);
  }
  const int low = lowOfCell(first);
  Polygon below = triangle, above;
  const Vec3 normal = normalOf(triangle);
  if (last > low + 1) {
    below.clear();
    split(triangle, axis, low + 2, below, above);
  }
  for (const Polygon& piece : trianglesOf(below, normal)) {
    keepWithin(axis, low, low + 1);
    cutAtNodes(axis + 1, piece, keep);
  }
  for (const Polygon& piece : trianglesOf(above, normal)) cutAtNodes(axis, piece, keep);
}

// In one cell: first at the points where edges meet bent planes along the axis, or the next ones,
// more than once.
void MeshPieces::cutInCell(int axis, const Polygon& triangle, int rounds, bool keep) {
  Polygon polygon;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner& from = triangle[i];
    polygon.push_back(from);
    const int to = triangle[(i + 1) % 3].vertex;
    if (rounds == 0 || from.vertex == to || axis == 3 || !grid_.isBent(first_)) continue;
    for (const int turn : turns(from.vertex, to, axis)) polygon.push_back({turn, from.face});
  }
  if (polygon.size() == 3) return cutBetweenNodes(axis, triangle, keep);
  const HalfIndex first = first_, last = last_;
  for (const Polygon& piece : trianglesOf(polygon, normalOf(triangle))) {
    first_ = first;
    last_ = last;
    cutInCell(axis, piece, rounds - 1, keep);
  }
}

void MeshPieces::cutBetweenNodes(int axis, const Polygon& triangle, bool keep) {
  for (int uncut = axis; uncut < 3; ++uncut) keepWithinCell(uncut);
  if (axis == 3) {
    if (keep) keepPiece(triangle);
    return;
  }
  const int low = first_[at(axis)];
  Polygon below, above;
  const Vec3 normal = normalOf(triangle);
  split(triangle, axis, low + 1, below, above);
  bend(triangle, axis, below, above);
  for (const Polygon& piece : trianglesOf(below, normal)) {
    keepWithin(axis, low, low);
    cutInCell(axis + 1, piece, kMostTurns, keep);
  }
  for (const Polygon& piece : trianglesOf(above, normal)) {
    keepWithin(axis, low + 1, low + 1);
    cutInCell(axis + 1, piece, kMostTurns, keep);
  }
}

// Of a piece without extent, as where a vertex is on a plane, the seams alone.
void MeshPieces::keepPiece(const Polygon& piece) {
  Piece kept;
  kept.octant = first_;
  kept.triangle = triangle_;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const int from = piece[i].vertex, to = piece[(i + 1) % piece.size()].vertex;
    if (from == to) continue;
    kept.outline.push_back(from);
    const int face = piece[i].face;
    if (face >= 0 && face % 2 == 1) seams_[seamOf(first_, face / 2)].push_back({from, to});
  }
  if (kept.outline.size() == 3) pieces_.push_back(std::move(kept));
}

int MeshPieces::gridPoint(const HalfIndex& point) {
  const auto [place, is_new] = grid_points_.try_emplace(point, 0);
  if (is_new) {
    place->second = addVertex(0.5 * Vec3(point[0], point[1], point[2]), grid_.placeOf(point));
  }
  return place->second;
}

// The part inside the mesh of an edge of the octants, half a spacing long.
void MeshPieces::addEdge(const HalfIndex& start, int axis, Direction direction,
                         std::vector<Segment>& border) {
  const auto line = lines_.find({axis, start[at(next(axis))], start[at(afterNext(axis))]});
  if (line == lines_.end()) return;  // all outside: a line inside enters and leaves
  std::vector<Crossing> on_edge;
  int inside = 0;
  for (const Crossing& crossing : line->second) {
    if (crossing.octant < start[at(axis)]) inside += crossing.change;
    if (crossing.octant == start[at(axis)]) on_edge.push_back(crossing);
  }
  std::sort(on_edge.begin(), on_edge.end(), [](const Crossing& a, const Crossing& b) {
    return std::make_pair(a.place, a.vertex) < std::make_pair(b.place, b.vertex);
  });
  HalfIndex end = start;
  ++end[at(axis)];
  int from = inside != 0 ? gridPoint(start) : -1;
  const auto go = [&](int to) {
    if (from == to) return;
    for (int times = 0; times < std::abs(inside); ++times) {
      const bool as_axis = (inside > 0) == (direction == Direction::kForwards);
      border.push_back(as_axis ? Segment{from, to} : Segment{to, from});
    }
    from = to;
  };
  for (const Crossing& crossing : on_edge) {
    go(crossing.vertex);
    inside += crossing.change;
  }
  if (inside != 0) go(gridPoint(end));
}

std::vector<MeshPieces::Segment> MeshPieces::border(const HalfIndex& octant, int axis) {
  std::vector<Segment> border;
  HalfIndex low = octant;
  ++low[at(axis)];
  if (low[at(axis)] >= octants_[at(axis)]) return border;
  HalfIndex right = low, up = low;
  ++right[at(next(axis))];
  ++up[at(afterNext(axis))];
  addEdge(low, next(axis), Direction::kForwards, border);
  addEdge(right, afterNext(axis), Direction::kForwards, border);
  addEdge(up, next(axis), Direction::kBackwards, border);
  addEdge(low, afterNext(axis), Direction::kBackwards, border);
  const auto seam = seams_.find(seamOf(octant, axis));
  if (seam == seams_.end()) return border;
  for (const auto& [from, to] : seam->second) border.push_back({to, from});
  return border;
}

// Followed from each vertex on; where one is met again, what lies between is a loop.
std::vector<std::vector<int>> MeshPieces::lid(const HalfIndex& octant, int axis) {
  std::multimap<int, int> onwards;
  for (const auto& [from, to] : border(octant, axis)) onwards.emplace(from, to);
  std::vector<std::vector<int>> loops;
  std::vector<int> path;
  while (!onwards.empty()) {
    if (path.empty()) path.push_back(onwards.begin()->first);
    const auto step = onwards.find(path.back());
    const int to = step->second;
    onwards.erase(step);
    const auto met = std::find(path.begin(), path.end(), to);
    if (met == path.end()) {
      path.push_back(to);
      continue;
    }
    if (path.end() - met > 2) loops.emplace_back(met, path.end());  // of two: to and fro
    path.erase(met + 1, path.end());
    if (onwards.find(to) == onwards.end()) path.clear();
  }
  return loops;
}

}  // namespace robot_tissue
