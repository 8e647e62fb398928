#include "solvers/multigrid/level/group_inverse.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

using Modes = Eigen::Matrix<double, 6, 1>;

// Over the stiffness along each axis, as shifts and turns have other units.
GroupMatrix inverseWhereStiff(const GroupMatrix& stiffness, double scale) {
  Modes unit;
  for (int axis = 0; axis < 6; ++axis) {
    const double own = stiffness(axis, axis);
    unit[axis] = own > level_tuning::kNoStiffness * scale ? 1.0 / std::sqrt(own) : 0.0;
  }
  const GroupMatrix even = unit.asDiagonal() * stiffness * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<GroupMatrix> modes(even);
  Modes inverses;
  for (int mode = 0; mode < 6; ++mode) {
    const double own = modes.eigenvalues()[mode];
    inverses[mode] = own > level_tuning::kNoTurn ? 1.0 / own : 0.0;
  }
  const GroupMatrix along = unit.asDiagonal() * modes.eigenvectors();
  return along * inverses.asDiagonal() * along.transpose();
}

}  // namespace

GroupMatrix inverseOfGroup(GroupMatrix stiffness, bool turns) {
  const double scale = stiffness.diagonal().maxCoeff();
  if (turns && scale > 0.0) return inverseWhereStiff(stiffness, scale);
  for (int axis = 0; axis < 6; ++axis) {
    double& own = stiffness(axis, axis);
    if (own <= level_tuning::kNoStiffness * scale) own = std::max(scale, 1.0);
  }
  GroupMatrix inverse = stiffness.inverse();
  inverse.bottomRightCorner<3, 3>().setZero();
  return inverse;
}

}  // namespace robot_tissue
