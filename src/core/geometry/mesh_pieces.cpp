#include "geometry/mesh_pieces.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/polygon_triangles.h"

namespace robot_tissue {
namespace {

// Barycentric (1): a bend is so far inside a triangle at least. Less: slivers. Chosen.
constexpr double kInside = 1e-6;

// Half spacings along the two next axes, from the middle of a bent plane to where it bends.
constexpr std::array<std::pair<int, int>, 8> kAround = {
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

int next(int axis) { return (axis + 1) % 3; }
int afterNext(int axis) { return (axis + 2) % 3; }

int lowOfCell(int octant) { return octant - octant % 2; }

std::array<int, 4> seamOf(const HalfIndex& octant, int axis) {
  return {octant[0], octant[1], octant[2], axis};
}

}  // namespace

MeshPieces::MeshPieces(std::vector<Vec3> vertices, const std::array<int, 3>& cells,
                       const BentGrid& grid)
    : grid_(grid),
      octants_{2 * cells[0], 2 * cells[1], 2 * cells[2]},
      points_(std::move(vertices), octants_, grid) {}

void MeshPieces::add(const MeshTriangle& triangle, int number, bool keep_pieces) {
  triangle_ = number;
  cutAtNodes(0, {{triangle[0], -1}, {triangle[1], -1}, {triangle[2], -1}}, keep_pieces);
}

void MeshPieces::split(const Polygon& triangle, int axis, int plane, Polygon& below,
                       Polygon& above) {
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    const Corner& from = triangle[i];
    const Corner& to = triangle[(i + 1) % triangle.size()];
    const bool starts_above = points_.isAbove(from.vertex, axis, plane);
    (starts_above ? above : below).push_back(from);
    if (starts_above == points_.isAbove(to.vertex, axis, plane)) continue;
    const int cut = points_.crossing(from.vertex, to.vertex, axis, plane);
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
  const int rise = points_.isAbove(from.vertex, axis, plane) ? 1 : -1;
  HalfIndex planes{};
  planes[at(axis)] = plane;
  planes[at(across)] = static_cast<int>(std::lround(2.0 * points_.straight(vertex)[across]));
  const double place = points_.straight(vertex)[along];
  const int octant =
      std::clamp(points_.octantOf(points_.straight(vertex))[at(along)], first_[at(along)],
                 last_[at(along)]);  // the edge's
  lines_[{along, planes[at(next(along))], planes[at(afterNext(along))]}].push_back(
      {place, vertex, octant, turn * rise});
}

// Where the lines along which the facets of the bent plane meet pass through the triangle, in the
// order from one vertex to the other.
std::vector<int> MeshPieces::bendsBetween(int from, int to, const Polygon& triangle, int axis) {
  const HalfIndex middle = {lowOfCell(first_[0]) + 1, lowOfCell(first_[1]) + 1,
                            lowOfCell(first_[2]) + 1};
  // Copies: adding a point moves the others.
  const Vec3 a = points_.place(triangle[0].vertex), b = points_.place(triangle[1].vertex),
             c = points_.place(triangle[2].vertex);
  const Vec3 area = normalOf(triangle);
  const Vec3 start = grid_.placeOf(middle);
  const Vec3 along = points_.place(to) - points_.place(from);
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
    const Vec3 from_start = place - points_.place(from);
    const bool is_straight = along.cross(from_start).norm() < MeshPoints::kOnPlane * along.norm();
    if (is_straight || !(least > kInside * area.squaredNorm())) continue;
    Vec3 straight = 0.5 * Vec3(middle[0], middle[1], middle[2]);
    straight[next(axis)] += 0.5 * share * u;
    straight[afterNext(axis)] += 0.5 * share * v;
    bends.emplace_back(along.dot(place), points_.add(straight, place));
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
  for (const Corner& corner : polygon) places.push_back(points_.place(corner.vertex));
  return polygonTriangles(places, normal).triangles;
}

Vec3 MeshPieces::normalOf(const Polygon& triangle) const {
  const Vec3& first = points_.place(triangle[0].vertex);
  return (points_.place(triangle[1].vertex) - first)
      .cross(points_.place(triangle[2].vertex) - first);
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
  if (axis == 3) return cutInCell(0, triangle, MeshPoints::kMostTurns, keep);
  int first = octants_[at(axis)];
  int last = 0;
  for (const Corner& corner : triangle) {
    const int octant = points_.octantOf(points_.straight(corner.vertex))[at(axis)];
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
    for (const int turn : points_.turns(from.vertex, to, axis))
      polygon.push_back({turn, from.face});
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
    cutInCell(axis + 1, piece, MeshPoints::kMostTurns, keep);
  }
  for (const Polygon& piece : trianglesOf(above, normal)) {
    keepWithin(axis, low + 1, low + 1);
    cutInCell(axis + 1, piece, MeshPoints::kMostTurns, keep);
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
    place->second = points_.add(0.5 * Vec3(point[0], point[1], point[2]), grid_.placeOf(point));
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
