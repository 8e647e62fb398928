#include "geometry/mesh_pieces.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

int next(int axis) { return (axis + 1) % 3; }
int afterNext(int axis) { return (axis + 2) % 3; }

std::array<int, 4> seamOf(const HalfIndex& octant, int axis) {
  return {octant[0], octant[1], octant[2], axis};
}

}  // namespace

MeshPieces::MeshPieces(std::vector<Vec3> vertices, const std::array<int, 3>& cells)
    : vertices_(std::move(vertices)) {
  for (std::size_t axis = 0; axis < 3; ++axis) octants_[axis] = 2 * cells[axis];
}

void MeshPieces::add(const MeshTriangle& triangle, bool keep_pieces) {
  cutAlong(0, {{triangle[0], -1}, {triangle[1], -1}, {triangle[2], -1}}, keep_pieces);
}

int MeshPieces::addVertex(const Vec3& place) {
  vertices_.push_back(place);
  return static_cast<int>(vertices_.size()) - 1;
}

int MeshPieces::addMiddle(const std::vector<int>& points) {
  Vec3 sum = Vec3::Zero();
  for (const int point : points) sum += vertices_[at(point)];
  return addVertex(sum / static_cast<double>(points.size()));
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

// Along the axes before this one the edge has been cut already: the point is in its octant there.
int MeshPieces::crossing(int from, int to, int axis, int plane) {
  const auto [low, high] = std::minmax(from, to);
  const auto [known, is_new] =
      crossings_.try_emplace(std::array<int, 4>{low, high, axis, plane}, 0);
  if (is_new) {
    const Vec3 a = vertices_[at(low)], b = vertices_[at(high)];
    Vec3 place = a + (0.5 * plane - a[axis]) / (b[axis] - a[axis]) * (b - a);
    place = place.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
    for (int other = 0; other < axis; ++other) {
      if (a[other] == b[other]) continue;                                    // in a plane
      const double octant = std::floor(2.0 * std::min(a[other], b[other]));  // that the edge is in
      const double end = 0.5 * (octant + 1.0);
      place[other] = std::clamp(place[other], 0.5 * octant, std::nextafter(end, 0.0));
    }
    place[axis] = 0.5 * plane;
    known->second = addVertex(place);
  }
  return known->second;
}

// From below to above along each axis, as cutAlong does, so that the points are the same.
std::vector<int> MeshPieces::subdivided(int from, int to) {
  std::vector<int> points = {from, to};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<int> finer = {points.front()};
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const int start = octantOf(vertices_[at(points[i])])[at(axis)];
      const int end = octantOf(vertices_[at(points[i + 1])])[at(axis)];
      const int upper = start < end ? points[i + 1] : points[i];
      int lower = start < end ? points[i] : points[i + 1];
      std::vector<int> between;
      for (int plane = std::min(start, end) + 1; plane <= std::max(start, end); ++plane) {
        lower = crossing(lower, upper, axis, plane);
        between.push_back(lower);
      }
      if (start > end) std::reverse(between.begin(), between.end());
      finer.insert(finer.end(), between.begin(), between.end());
      finer.push_back(points[i + 1]);
    }
    points.swap(finer);
  }
  return points;
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
  lines_[{along, planes[at(next(along))], planes[at(afterNext(along))]}].push_back(
      {vertices_[at(vertex)][along], vertex, turn * rise});
}

std::vector<MeshPieces::Polygon> MeshPieces::trianglesOf(const Polygon& polygon) {
  std::vector<Polygon> triangles;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
    if (i > 1) triangles.back()[0].face = -1;
    if (i + 2 < polygon.size()) triangles.back()[2].face = -1;
  }
  return triangles;
}

void MeshPieces::cutAlong(int axis, const Polygon& triangle, bool keep) {
  if (axis == 3) {
    if (keep) keepPiece(triangle);
    return;
  }
  int first = octants_[at(axis)];
  int last = 0;
  for (const Corner& corner : triangle) {
    const int octant = octantOf(vertices_[at(corner.vertex)])[at(axis)];
    first = std::min(first, octant);
    last = std::max(last, octant);
  }
  if (first == last) {
    octant_[at(axis)] = first;
    cutAlong(axis + 1, triangle, keep);
    return;
  }
  Polygon below, above;
  split(triangle, axis, first + 1, below, above);
  for (const Polygon& piece : trianglesOf(below)) {
    octant_[at(axis)] = first;
    cutAlong(axis + 1, piece, keep);
  }
  for (const Polygon& piece : trianglesOf(above)) cutAlong(axis, piece, keep);
}

void MeshPieces::keepPiece(const Polygon& piece) {
  Piece kept;
  kept.octant = octant_;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    kept.outline.push_back(piece[i].vertex);
    const int face = piece[i].face;
    if (face < 0 || face % 2 == 0) continue;
    seams_[seamOf(octant_, face / 2)].push_back(
        {piece[i].vertex, piece[(i + 1) % piece.size()].vertex});
  }
  pieces_.push_back(std::move(kept));
}

int MeshPieces::gridPoint(const HalfIndex& point) {
  const auto [place, is_new] = grid_points_.try_emplace(point, 0);
  if (is_new) {
    place->second = addVertex(0.5 * Vec3(point[0], point[1], point[2]));
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
    const int octant = octantOf(vertices_[at(crossing.vertex)])[at(axis)];
    if (octant < start[at(axis)]) inside += crossing.change;
    if (octant == start[at(axis)]) on_edge.push_back(crossing);
  }
  std::sort(on_edge.begin(), on_edge.end(), [](const Crossing& a, const Crossing& b) {
    return std::make_pair(a.place, a.vertex) < std::make_pair(b.place, b.vertex);
  });
  HalfIndex end = start;
  ++end[at(axis)];
  int from = inside != 0 ? gridPoint(start) : -1;
  const auto go = [&](int to) {
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

std::vector<MeshPieces::Segment> MeshPieces::lid(const HalfIndex& octant, int axis) {
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

}  // namespace robot_tissue
