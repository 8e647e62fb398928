// The mean deformation gradient of a cell, as the kernel has it (cell_block.h, filled_block.h), of
// one cell in double precision. Lengths in spacings.
#pragma once

#include <Eigen/Core>
#include <array>

#include "solvers/multigrid/level/cell_operator.h"

namespace robot_tissue {

// m_s = M_s / 4 of cell_kernel.h.
template <typename Real>
Vec3 modeOf(const Field<Real>& displacement, const std::array<int, kCorners>& nodes, int mode) {
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < kCorners; ++corner) {
    const bool odd = __builtin_popcount(static_cast<unsigned>(mode & corner)) % 2 != 0;
    sum += (odd ? -0.25 : 0.25) * vectorAt(displacement, nodes[at(corner)]);
  }
  return sum;
}

// Of a full cell.
template <typename Real>
Eigen::Matrix3d meanStrain(const Field<Real>& displacement,
                           const std::array<int, kCorners>& nodes) {
  Eigen::Matrix3d strain = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 3; ++axis) strain.col(axis) -= modeOf(displacement, nodes, 1 << axis);
  return strain;
}

// Of one that is filled in part, over its fill (FilledBlock::shiftModes, reachOut).
template <typename Real>
Eigen::Matrix3d meanStrain(const Field<Real>& displacement, const FilledCell<Real>& cell) {
  std::array<Vec3, kCorners> modes;
  for (int mode = 1; mode < kCorners; ++mode) {
    modes[at(mode)] = modeOf(displacement, cell.nodes, mode);
  }
  Eigen::Matrix3d strain = Eigen::Matrix3d::Identity();
  const auto centroid = [&](int axis) { return static_cast<double>(cell.centroid[at(axis)]); };
  for (int a0 = 0; a0 < 3; ++a0) {
    const int b = (a0 + 1) % 3, c = (a0 + 2) % 3;
    const double pairs = static_cast<double>(cell.pairs[at(a0)]);
    Vec3 slope = modes[at(1 << a0)];
    slope -= 2.0 * (modes[at(7 ^ 1 << c)] * centroid(b) + modes[at(7 ^ 1 << b)] * centroid(c)) -
             4.0 * pairs * modes[7];
    Vec3 shift = Vec3::Zero();
    for (const int side : {2 * a0, 2 * a0 + 1}) {
      if (!cell.reach.has(side)) continue;
      Vec3 second = (side % 2 == 0 ? -1.0 : 1.0) * slope;
      for (int r = 0; r < kFaceNodes; ++r) {
        const double s_b = (r & 1) != 0 ? 1.0 : -1.0, s_c = (r & 2) != 0 ? 1.0 : -1.0;
        const double share =
            0.5 * (s_b * centroid(b) + s_c * centroid(c)) + s_b * s_c * pairs + 0.25;
        const int beyond = cell.reach.nodes[at(kFaceNodes * side + r)];
        const int before = cell.nodes[at(faceCorner(side, r))];
        second += share * (vectorAt(displacement, beyond) - vectorAt(displacement, before));
      }
      shift += static_cast<double>(cell.reach.share[at(side)]) * second;
    }
    strain.col(a0) -= slope - centroid(a0) * shift;
  }
  return strain;
}

}  // namespace robot_tissue
