#include "robot_tissue/core/cells.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {
namespace {

bool isWhole(const std::array<int, kCorners>& parts) {
  return std::all_of(parts.begin(), parts.end(), [](int part) { return part == 0; });
}

}  // namespace

CellSet::CellSet(std::vector<Cell> cells, int nodes)
    : cells_(std::move(cells)), first_(at(nodes) + 1, 0), meetings_(kCorners * cells_.size()) {
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

std::array<int, kCorners> cellParts(const Lattice& lattice, const LatticeState& state,
                                    const std::array<int, kCorners>& corners) {
  std::array<int, kCorners> parts{};
  if (state.springs_cut == 0) return parts;
  for (int corner = 0; corner < kCorners; ++corner) parts[at(corner)] = corner;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      const int other = corner | 1 << axis;
      if (state.severed[at(lattice.springOf(corners[at(corner)], 2 * axis + 1))] != 0) continue;
      const int from = std::max(parts[at(corner)], parts[at(other)]);
      const int to = std::min(parts[at(corner)], parts[at(other)]);
      std::replace(parts.begin(), parts.end(), from, to);
    }
  }
  return parts;
}

std::shared_ptr<const CellSet> cellsLeft(const Lattice& lattice, const LatticeState& state) {
  std::vector<Cell> left;
  for (const Cell& cell : lattice.cells()) {
    if (isWhole(cellParts(lattice, state, cell.nodes))) left.push_back(cell);
  }
  return std::make_shared<const CellSet>(std::move(left), lattice.nodeCount());
}

int countInvertedCells(const Lattice& lattice, const LatticeState& state) {
  int inverted = 0;
  for (const Cell& cell : state.cells->all()) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    for (int corner = 0; corner < kCorners; ++corner) {
      const Vec3& moved = state.displacement[at(cell.nodes[at(corner)])];
      for (int axis = 0; axis < 3; ++axis) {
        const double sign = (corner >> axis & 1) != 0 ? 0.25 : -0.25;
        gradient.col(axis) += sign / lattice.spacing() * moved;
      }
    }
    if (gradient.determinant() <= 0.0) ++inverted;
  }
  return inverted;
}

}  // namespace robot_tissue
