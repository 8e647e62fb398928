#include "robot_tissue/core/cells.h"

#include <algorithm>

namespace robot_tissue {
namespace {

bool isWhole(const std::array<int, kCorners>& parts) {
  return std::all_of(parts.begin(), parts.end(), [](int part) { return part == 0; });
}

}  // namespace

std::array<int, kCorners> cellCorners(const Lattice& lattice, int i, int j, int k) {
  std::array<int, kCorners> corners{};
  for (int corner = 0; corner < kCorners; ++corner) {
    corners[at(corner)] =
        lattice.node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
  }
  return corners;
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

int countInvertedCells(const Lattice& lattice, const LatticeState& state) {
  int inverted = 0;
  const auto& size = lattice.size();
  for (int k = 0; k + 1 < size[2]; ++k) {
    for (int j = 0; j + 1 < size[1]; ++j) {
      for (int i = 0; i + 1 < size[0]; ++i) {
        const auto corners = cellCorners(lattice, i, j, k);
        Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
        for (int corner = 0; corner < kCorners; ++corner) {
          const Vec3& moved = state.displacement[at(corners[at(corner)])];
          for (int axis = 0; axis < 3; ++axis) {
            const double sign = (corner >> axis & 1) != 0 ? 0.25 : -0.25;
            gradient.col(axis) += sign / lattice.spacing() * moved;
          }
        }
        if (gradient.determinant() > 0.0) continue;
        if (isWhole(cellParts(lattice, state, corners))) ++inverted;
      }
    }
  }
  return inverted;
}

}  // namespace robot_tissue
