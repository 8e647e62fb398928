#include "robot_tissue/core/cells.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "lattice/cell_reach.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {
namespace {

// Then what is across that axis has another measure than between nodes.
bool isHeldAcross(const Cell& cell, int axis) {
  return cell.fill != nullptr && cell.fill->isHeldAcross(axis);
}

}  // namespace

CellSet::CellSet(std::vector<Cell> cells, int lattice_nodes, std::vector<Ghost> ghosts)
    : cells_(std::move(cells)),
      ghosts_(std::move(ghosts)),
      node_count_(lattice_nodes + static_cast<int>(ghosts_.size())) {
  listMeetings();
  findReaches();
}

CellSet::CellSet(std::vector<Cell> cells, const std::array<int, 3>& points)
    : cells_(std::move(cells)), node_count_(points[0] * points[1] * points[2]), points_(points) {
  findReaches();
}

// The higher its corner that is the node, the lower is a cell's number.
CellSet::Meetings CellSet::meetingsOnGrid(int node) const {
  const int i = node % points_[0], row = node / points_[0];
  const int j = row % points_[1], k = row / points_[1];
  Meetings around;
  for (int corner = kCorners - 1; corner >= 0; --corner) {
    const int x = i - (corner & 1), y = j - (corner >> 1 & 1), z = k - (corner >> 2 & 1);
    if (x < 0 || y < 0 || z < 0) continue;
    if (x + 1 == points_[0] || y + 1 == points_[1] || z + 1 == points_[2]) continue;
    around.add({x + (points_[0] - 1) * (y + (points_[1] - 1) * z), corner});
  }
  return around;
}

void CellSet::listMeetings() {
  first_.assign(at(node_count_) + 1, 0);
  meetings_.resize(kCorners * cells_.size());
  for (const Cell& cell : cells_) {
    for (const int node : cell.nodes) ++first_[at(node) + 1];
  }
  for (std::size_t node = 1; node < first_.size(); ++node) first_[node] += first_[node - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cells_[cell].nodes[at(corner)];
      meetings_[at(next[at(node)]++)] = {static_cast<int>(cell), corner};
    }
  }
}

void CellSet::findReaches() {
  bool any = false;
  for (Cell& cell : cells_) {
    if (cell.fill == nullptr) {
      cell.reach.reset();
      continue;
    }
    SharedConst<CellReach> reach = reachOf(cell.share(), [&](int side) -> NeighborCell {
      const Cell* neighbor = across(cell, side);
      if (neighbor == nullptr || isHeldAcross(cell, side / 2)) return {};
      if (isHeldAcross(*neighbor, side / 2)) return {};
      return {&neighbor->nodes, neighbor->share()};
    });
    any = any || reach != nullptr;
    const bool same = reach != nullptr && cell.reach != nullptr &&
                      reach->share == cell.reach->share && reach->nodes == cell.reach->nodes;
    if (!same) cell.reach = std::move(reach);
  }
  if (any) listReaching();
}

void CellSet::listReaching() {
  first_reaching_.assign(at(node_count_) + 1, 0);
  const auto visit = [this](auto met) {
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      if (cells_[cell].reach == nullptr) continue;
      for (int place = 0; place < kBeyond; ++place) {
        const int node = cells_[cell].reach->nodes[at(place)];
        if (node >= 0) met(node, Meeting(static_cast<int>(cell), kCorners + place));
      }
    }
  };
  visit([this](int node, const Meeting&) { ++first_reaching_[at(node) + 1]; });
  for (std::size_t node = 1; node < first_reaching_.size(); ++node) {
    first_reaching_[node] += first_reaching_[node - 1];
  }
  reaching_.resize(at(first_reaching_.back()));
  std::vector<int> next(first_reaching_.begin(), first_reaching_.end() - 1);
  visit([&](int node, const Meeting& met) { reaching_[at(next[at(node)]++)] = met; });
}

// A corner's shape function is the product over the axes of (1/2 + s_a x_a), s_a = 1 at the high
// end, else -1.
ReachedSlopes reachedSlopes(const CellFill& fill, const CellReach* reach) {
  ReachedSlopes slopes;
  const auto add = [&](int node, int side, double weight) {
    const int axis = side / 2;
    slopes.squares[at(node)][axis] += reach->inMean(side) * weight;
    slopes.uneven[at(node)][axis] += reach->inUneven(side) * weight;
    slopes.strain[at(node)][axis] += fill.centroid[axis] * reach->share[at(side)] * weight;
  };
  for (int side = 0; side < kSides; ++side) {
    const int axis = side / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (int r = 0; r < kFaceNodes; ++r) {
      const double s_b = (r & 1) != 0 ? 1.0 : -1.0, s_c = (r & 2) != 0 ? 1.0 : -1.0;
      const double share = 0.25 + 0.5 * (s_b * fill.centroid[b] + s_c * fill.centroid[c]) +
                           s_b * s_c * fill.products(b, c);
      slopes.strain[at(faceCorner(side, r))][axis] += side % 2 == 0 ? -share : share;
      if (reach == nullptr || !reach->has(side)) continue;
      add(faceCorner(side, r), side, -2.0 * share);
      add(faceCorner(side ^ 1, r), side, share);
      add(kCorners + kFaceNodes * side + r, side, share);
    }
  }
  return slopes;
}

const Cell* CellSet::owner(int place, int corner) const {
  const auto before = [](const Cell& cell, int other) { return cell.place < other; };
  for (auto cell = std::lower_bound(cells_.begin(), cells_.end(), place, before);
       cell != cells_.end() && cell->place == place; ++cell) {
    if (cell->owns(corner)) return &*cell;
  }
  return nullptr;
}

int CellSet::nodeOf(const CellSet& from, int node) const {
  if (!from.isGhost(node)) return node;
  for (const Meeting& met : from.meetings(node)) {
    const Cell& part = from.cells_[met.cell];
    const Cell* here = owner(part.place, part.lowestOwn());
    if (here != nullptr) return here->nodes[met.corner];
  }
  return -1;
}

const Cell* CellSet::across(const Cell& cell, int side) const {
  const int node = cell.nodes[at(faceCorner(side, 0))];
  for (const Meeting& met : meetings(node)) {
    const Cell& other = cells_[met.cell];
    if (haveInCommon(cell.nodes, side, other.nodes)) return &other;
  }
  return nullptr;
}

Vec3 restPosition(const Lattice& lattice, const CellSet& cells, int node) {
  return lattice.restPosition(cells.original(node));
}

bool isFixed(const Lattice& lattice, const CellSet& cells, int node) {
  if (!cells.isGhost(node)) return lattice.isFixed(node);
  return cells.ghosts()[at(node - lattice.nodeCount())].fixed;
}

namespace {

// Where the material is.
bool isInvertedInPart(const Cell& cell, const LatticeState& state, double spacing) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  const ReachedSlopes slopes = reachedSlopes(*cell.fill, cell.reach.get());
  const std::array<int, kMostReached> nodes = reachedNodes(cell);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0) continue;
    gradient += state.displacement[at(nodes[i])] * slopes.strain[i].transpose() / spacing;
  }
  return gradient.determinant() <= 0.0;
}

bool isInverted(const Cell& cell, const LatticeState& state, double share) {
  if (cell.fill != nullptr) return isInvertedInPart(cell, state, 0.25 / share);
  const auto moved = [&](std::size_t corner) -> const Vec3& {
    return state.displacement[at(cell.nodes[corner])];
  };
  const Vec3 low = moved(1) - moved(6), high = moved(7) - moved(0);
  const Vec3 near = moved(3) - moved(4), far = moved(5) - moved(2);
  const Vec3 x = share * (low + high + near + far) + Vec3::UnitX();
  const Vec3 y = share * (near + high - low - far) + Vec3::UnitY();
  const Vec3 z = share * (far + high - low - near) + Vec3::UnitZ();
  return x.dot(y.cross(z)) <= 0.0;
}

}  // namespace

int countInvertedCells(const Lattice& lattice, const LatticeState& state) {
  const double share = 0.25 / lattice.spacing();
  int inverted = 0;
  for (const Cell& cell : state.cells->all()) inverted += isInverted(cell, state, share) ? 1 : 0;
  return inverted;
}

int countInvertedCells(const Lattice& lattice, const LatticeState& state, const GridBox& points) {
  const double share = 0.25 / lattice.spacing();
  const CellSet& cells = *state.cells;
  int inverted = 0;
  const auto count_at = [&](int lowest) {
    for (const CellSet::Meeting& met : cells.meetings(lowest)) {
      if (met.corner == 0 && isInverted(cells.all()[met.cell], state, share)) ++inverted;
    }
  };
  for (int k = points.low[2] - 1; k <= points.high[2]; ++k) {
    for (int j = points.low[1] - 1; j <= points.high[1]; ++j) {
      for (int i = points.low[0] - 1; i <= points.high[0]; ++i) {
        const int lowest = lattice.node(i, j, k);
        if (lowest >= 0) count_at(lowest);
      }
    }
  }
  GridBox lowest = points;
  for (int& low : lowest.low) --low;
  for (int node = cells.latticeNodeCount(); node < cells.nodeCount(); ++node) {
    if (lowest.has(lattice.gridIndex(cells.original(node)))) count_at(node);
  }
  return inverted;
}

}  // namespace robot_tissue
