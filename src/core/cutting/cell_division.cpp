#include "cutting/cell_division.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cutting/cut_front.h"
#include "lattice/held_layers.h"
#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {
namespace {

// Spacings (1): a face's or a cell's point is at least so far inside it. More: where planes cross
// near a side, the wound bends; less: slivers that vanish in rounding. Chosen.
constexpr double kInside = 1e-3;
// Of a plane's weight (1): what holds the inside point where planes leave it free. Rounding.
constexpr double kHold = 1e-6;

// Of a cell (1): so much of a fill is spread evenly, so that no part is without any. Rounding.
constexpr double kEven = 1e-6;
// Spacings (1): a fill's box is so thick at least, half of it. Less: sheets vanish in rounding.
constexpr double kThin = 1e-3;

using Points = std::vector<Vec3>;

CellPoint pointOf(int corner) { return {2 * (corner & 1), corner & 2, (corner & 4) / 2}; }

// From the corner along the axis.
CellPoint edgeOf(int corner, int axis) {
  CellPoint edge = pointOf(corner);
  edge[at(axis)] = 1;
  return edge;
}

Vec3 meanOf(const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

double inside(double place) { return std::clamp(place, kInside, 1.0 - kInside); }

// Where the line between places on the two edges across u meets that between those across v.
Eigen::Vector2d crossing(const std::array<double, 2>& along_u,
                         const std::array<double, 2>& along_v) {
  const double slope_u = along_u[1] - along_u[0], slope_v = along_v[1] - along_v[0];
  const double u = (along_u[0] + slope_u * along_v[0]) / (1.0 - slope_u * slope_v);
  return {u, along_v[0] + slope_v * u};
}

// Nearest to the planes through each set of points, and to their mean where these leave it free.
Vec3 nearestToPlanes(const std::map<std::pair<int, int>, Points>& sets, const Vec3& mean) {
  Eigen::Matrix3d matrix = kHold * Eigen::Matrix3d::Identity();
  Vec3 right = Vec3::Zero();
  for (const auto& [parts, points] : sets) {
    if (points.size() < 3) continue;
    const Vec3 middle = meanOf(points);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vec3& point : points) spread += (point - middle) * (point - middle).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    if (axes.eigenvalues()[1] < kHold) continue;  // on a line
    const Vec3 normal = axes.eigenvectors().col(0);
    matrix += normal * normal.transpose();
    right += normal * normal.dot(middle - mean);
  }
  return mean + matrix.ldlt().solve(right);
}

// The box along the axes of the covariance that has it: of half length a its variance is a^2/3.
std::vector<HalfSpace> boxOf(const CellFill& fill) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(fill.covariance());
  std::vector<HalfSpace> sides;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = std::max(kThin, std::sqrt(3.0 * std::max(0.0, axes.eigenvalues()[axis])));
    const Vec3 along = axes.eigenvectors().col(axis);
    const double middle = along.dot(fill.centroid);
    sides.push_back({along, middle + half});
    sides.push_back({-along, half - middle});
  }
  return sides;
}

}  // namespace

std::array<int, 4> cellsAround(const Lattice& lattice, const Spring& spring) {
  std::array<int, 4> cells{};
  for (int side = 0; side < 4; ++side) {
    std::array<int, 3> lowest = lattice.gridIndex(spring.a);
    lowest[at((spring.axis + 1) % 3)] -= side >> 1;
    lowest[at((spring.axis + 2) % 3)] -= side & 1;
    cells[at(side)] = lattice.cellAt(lowest);
  }
  return cells;
}

std::vector<char> cellsWithSevered(const Lattice& lattice, const LatticeState& state) {
  std::vector<char> has(lattice.cells().size(), 0);
  for (std::size_t index = 0; index < state.severed.size(); ++index) {
    if (state.severed[index] == 0) continue;
    for (const int cell : cellsAround(lattice, lattice.springs()[index])) {
      if (cell >= 0) has[at(cell)] = 1;
    }
  }
  return has;
}

bool hasPartedSprings(const Lattice& lattice, const LatticeState& state, const Cell& cell) {
  if (state.springs_cut == 0) return false;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      if (partedAt(state, lattice.springOf(cell.nodes[at(corner)], 2 * axis + 1)) > 0.0) {
        return true;
      }
    }
  }
  return false;
}

CellDivision::CellDivision() {
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) points_[indexOf({x, y, z})] = 0.5 * Vec3(x, y, z);
    }
  }
}

CellDivision::CellDivision(const Lattice& lattice, const LatticeState& state, const Cell& cell,
                           Ahead ahead)
    : CellDivision() {
  placeEdges(lattice, state, cell, ahead);
  for (int side = 0; side < 6; ++side) placeFace(side / 2, side % 2);
  placeInside();
}

void CellDivision::placeEdges(const Lattice& lattice, const LatticeState& state, const Cell& cell,
                              Ahead ahead) {
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      const int spring = lattice.springOf(cell.nodes[robot_tissue::at(corner)], 2 * axis + 1);
      double parted_at = partedAt(state, spring);
      if (ahead == Ahead::kParted) {
        if (const SpringAhead* front = aheadAt(state, spring)) parted_at = front->along;
      }
      if (parted_at == 0.0) continue;
      const CellPoint edge = edgeOf(corner, axis);
      parted_[indexOf(edge)] = true;
      points_[indexOf(edge)][axis] = parted_at;
    }
  }
}

void CellDivision::placeFace(int across, int side) {
  const int u = (across + 1) % 3, v = (across + 2) % 3;
  CellPoint middle = {1, 1, 1};
  middle[robot_tissue::at(across)] = 2 * side;
  std::array<double, 2> along_u{}, along_v{};  // of the edges along u, at both ends of v
  std::array<Vec3, 4> parted;
  int count = 0, count_u = 0;
  for (const int end : {0, 1}) {
    CellPoint edge_u = middle, edge_v = middle;
    edge_u[robot_tissue::at(v)] = edge_v[robot_tissue::at(u)] = 2 * end;
    along_u[robot_tissue::at(end)] = at(edge_u)[u];
    along_v[robot_tissue::at(end)] = at(edge_v)[v];
    count_u += isParted(edge_u) ? 1 : 0;
    for (const CellPoint& edge : {edge_u, edge_v}) {
      if (isParted(edge)) parted[robot_tissue::at(count++)] = at(edge);
    }
  }
  if (count < 2) return;
  Vec3& point = points_[indexOf(middle)];
  if (count == 2) {
    point = 0.5 * (parted[0] + parted[1]);
    return;
  }
  // Of three, the odd one goes on straight to the line between the two others.
  if (count == 3) {
    auto& odd = count_u == 1 ? along_u : along_v;
    CellPoint first = middle;
    first[robot_tissue::at(count_u == 1 ? v : u)] = 0;
    odd.fill(isParted(first) ? odd[0] : odd[1]);
  }
  const Eigen::Vector2d place = crossing(along_u, along_v);
  point[u] = inside(place.x());
  point[v] = inside(place.y());
}

// Of the face's edges.
int CellDivision::partedEdges(const CellPoint& face, int across) const {
  int count = 0;
  for (const int axis : {(across + 1) % 3, (across + 2) % 3}) {
    for (const int end : {0, 2}) {
      CellPoint edge = face;
      edge[robot_tissue::at(axis)] = end;
      count += isParted(edge) ? 1 : 0;
    }
  }
  return count;
}

std::vector<CellDivision::PartedEdge> CellDivision::edgesBetweenParts() const {
  DisjointSets parts(kCorners);
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!isParted(edgeOf(corner, axis))) parts.join(corner, corner ^ 1 << axis);
    }
  }
  std::vector<PartedEdge> edges;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      const int part = parts.lowest(corner), other = parts.lowest(corner | 1 << axis);
      if (part != other) edges.push_back({edgeOf(corner, axis), axis, std::minmax(part, other)});
    }
  }
  return edges;
}

void CellDivision::placeInside() {
  const std::vector<PartedEdge> edges = edgesBetweenParts();
  if (edges.empty()) return;
  Points all;
  for (const PartedEdge& edge : edges) all.push_back(at(edge.middle));
  Vec3& point = points_[indexOf({1, 1, 1})];
  point = meanOf(all);
  const bool are_two = std::all_of(edges.begin(), edges.end(), [&](const PartedEdge& edge) {
    return edge.parts == edges.front().parts;
  });
  if (!are_two) point = nearestToPlanes(pointsBetween(edges), point);
  for (int axis = 0; axis < 3; ++axis) point[axis] = inside(point[axis]);
}

// Of each two parts: of the edges between them, and of the faces that have another parted edge.
std::map<std::pair<int, int>, std::vector<Vec3>> CellDivision::pointsBetween(
    const std::vector<PartedEdge>& edges) const {
  std::map<std::pair<int, int>, Points> between;
  for (const PartedEdge& edge : edges) {
    Points& points = between[edge.parts];
    points.push_back(at(edge.middle));
    for (const int across : {(edge.axis + 1) % 3, (edge.axis + 2) % 3}) {
      CellPoint face = edge.middle;
      face[robot_tissue::at(3 - edge.axis - across)] = 1;
      if (partedEdges(face, across) > 1) points.push_back(at(face));
    }
  }
  return between;
}

std::array<Tetrahedron, 6> CellDivision::aroundCorner(int corner) const {
  const Vec3 middle = Vec3::Constant(0.5);
  const CellPoint from = pointOf(corner);
  std::array<Tetrahedron, 6> around;
  std::size_t count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const CellPoint edge = edgeOf(corner, axis);
    for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
      CellPoint face = edge;
      face[robot_tissue::at(other)] = 1;
      around[count++] = {at(from) - middle, at(edge) - middle, at(face) - middle,
                         at({1, 1, 1}) - middle};
    }
  }
  return around;
}

// Also cells that are whole may have springs that are parted.
CellDivisions::CellDivisions(const Lattice& lattice, const LatticeState& state) {
  if (state.springs_cut == 0) return;
  division_of_.assign(lattice.cells().size(), -1);
  const std::vector<char> has_severed = cellsWithSevered(lattice, state);
  for (const Cell& cell : lattice.cells()) {
    if (has_severed[at(cell.place)] == 0 || !hasPartedSprings(lattice, state, cell)) continue;
    division_of_[at(cell.place)] = static_cast<int>(divisions_.size());
    divisions_.emplace_back(lattice, state, cell);
  }
}

std::array<FillIntegrals, kCorners> cornerFills(const Lattice& lattice, const LatticeState& state,
                                                const Cell& cell) {
  std::array<FillIntegrals, kCorners> fills;
  if (!hasPartedSprings(lattice, state, cell)) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const auto bit = static_cast<std::uint8_t>(1 << corner);
      fills[at(corner)] = octantIntegrals(bit).scaledBy(cell.share());
    }
    return fills;
  }
  const bool is_front = frontParts(lattice, state, cell) != std::array<int, kCorners>{};
  const CellDivision division(
      lattice, state, cell, is_front ? CellDivision::Ahead::kParted : CellDivision::Ahead::kWhole);
  for (int corner = 0; corner < kCorners; ++corner) {
    FillIntegrals& even = fills[at(corner)];
    for (const Tetrahedron& solid : division.aroundCorner(corner)) even += integralsOver(solid);
  }
  if (cell.fill == nullptr) return fills;
  const std::vector<HalfSpace> box = boxOf(fillInMesh(*cell.fill));
  double in_box = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    FillIntegrals& fill = fills[at(corner)];
    fill = fill.scaledBy(kEven);
    for (const Tetrahedron& solid : division.aroundCorner(corner)) {
      fill += integralsWithin(box, solid);
    }
    in_box += fill.volume;
  }
  for (FillIntegrals& fill : fills) fill = fill.scaledBy(cell.share() / in_box);
  return fills;
}

}  // namespace robot_tissue
