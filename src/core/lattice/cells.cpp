#include "robot_tissue/core/cells.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {
CellSet::CellSet(std::vector<Cell> cells, int lattice_nodes, std::vector<Ghost> ghosts)
    : cells_(std::move(cells)),
      ghosts_(std::move(ghosts)),
      first_(at(lattice_nodes) + ghosts_.size() + 1, 0),
      meetings_(kCorners * cells_.size()) {
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

const Cell* CellSet::owner(int place, int corner) const {
  const auto before = [](const Cell& cell, int other) { return cell.place < other; };
  for (auto cell = std::lower_bound(cells_.begin(), cells_.end(), place, before);
       cell != cells_.end() && cell->place == place; ++cell) {
    if (cell->owns(corner)) return &*cell;
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

// Mean over the fill of the gradient of the corner's shape function, the product over the axes of
// (1/2 + s_a x_a) with s_a = 1 at the high end, else -1 (1/h).
Vec3 meanSlope(const CellFill& fill, int corner) {
  Vec3 side, slope;
  for (int axis = 0; axis < 3; ++axis) side[axis] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    slope[a] = side[a] * (0.25 + 0.5 * (side[b] * fill.centroid[b] + side[c] * fill.centroid[c]) +
                          side[b] * side[c] * fill.products(b, c));
  }
  return slope;
}

// Where the material is.
bool isInvertedInPart(const Cell& cell, const LatticeState& state, double spacing) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  for (int corner = 0; corner < kCorners; ++corner) {
    gradient += state.displacement[at(cell.nodes[at(corner)])] *
                meanSlope(*cell.fill, corner).transpose() / spacing;
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
    for (const auto* met = cells.first(lowest); met != cells.last(lowest); ++met) {
      if (met->corner == 0 && isInverted(cells.all()[met->cell], state, share)) ++inverted;
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
