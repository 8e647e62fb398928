#include "solvers/baselines/node_step.h"

#include <Eigen/Eigenvalues>

#include "solvers/baselines/tuning.h"

namespace robot_tissue {
Eigen::Matrix3d firm(const Eigen::Matrix3d& block) {
  const double area = block(0, 0) * block(1, 1) - block(0, 1) * block(1, 0);
  const double stiffest = block.trace();
  if (block(0, 0) > 0.0 && area > 0.0 &&
      block.determinant() > tuning::kSoftest * tuning::kSoftest * stiffest * stiffest * stiffest) {
    return block;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block);
  const double least = tuning::kSoftest * solver.eigenvalues().cwiseAbs().maxCoeff();
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(least).asDiagonal() *
         solver.eigenvectors().transpose();
}

Vec3 capped(const Vec3& step, double length) {
  const double norm = step.norm();
  return norm > length ? Vec3(step * (length / norm)) : step;
}

}  // namespace robot_tissue
