#include "membrane/stretched_triangle.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace robot_tissue {
namespace {

Eigen::Matrix2d positivePart(const Eigen::Matrix2d& matrix) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(matrix);
  if (solver.eigenvalues().minCoeff() >= 0.0) return matrix;
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

StretchedTriangle::StretchedTriangle(const SheetLaw& law, const Corners& rest)
    : shear_(law.shear), exponent_(law.exponent) {
  const Vec3 along = rest[1] - rest[0], other = rest[2] - rest[0];
  const Vec3 normal = along.cross(other);
  area_ = 0.5 * normal.norm();
  const Vec3 x = along.normalized(), y = normal.cross(along).normalized();
  Eigen::Matrix2d edges;
  edges << along.dot(x), other.dot(x), along.dot(y), other.dot(y);
  const Eigen::Matrix2d inverse = edges.inverse();
  slopes_.col(1) = inverse.row(0).transpose();
  slopes_.col(2) = inverse.row(1).transpose();
  slopes_.col(0) = -slopes_.col(1) - slopes_.col(2);
}

StretchedTriangle::Strain StretchedTriangle::strainOf(const Corners& places) const {
  Strain strain;
  strain.F = (places[1] - places[0]) * slopes_.col(1).transpose() +
             (places[2] - places[0]) * slopes_.col(2).transpose();
  const Eigen::Matrix2d C = strain.F.transpose() * strain.F;
  strain.determinant = C.determinant();
  strain.inverse = C.inverse();
  strain.power = std::pow(strain.determinant, -exponent_);
  return strain;
}

double StretchedTriangle::energy(const Corners& places) const {
  const Strain strain = strainOf(places);
  const double stretched = std::log(strain.determinant);
  const double of_area =
      exponent_ > 0.0 ? std::expm1(-exponent_ * stretched) / exponent_ : -stretched;
  return 0.5 * shear_ * area_ * (strain.F.squaredNorm() - 2.0 + of_area);
}

// dE/dx_i = A F S b_i, b_i the slope of the corner's weight.
StretchedTriangle::Corners StretchedTriangle::gradient(const Corners& places) const {
  const Strain strain = strainOf(places);
  const Eigen::Matrix2d stress =
      shear_ * (Eigen::Matrix2d::Identity() - strain.power * strain.inverse);
  const Eigen::Matrix3d on_corners = area_ * strain.F * stress * slopes_;
  return {on_corners.col(0), on_corners.col(1), on_corners.col(2)};
}

// With f_i = F C^-1 b_i, P = F C^-1 F^T the projection to the triangle's plane and D = det C^-s,
//
//   d2E/dx_i dx_j = A [(b_i . S b_j) 1
//                      + mu t D (2 s f_i f_j^T + f_j f_i^T + (b_i . C^-1 b_j) P)]
StretchedTriangle::Hessian StretchedTriangle::hessian(const Corners& places,
                                                      Curvature curvature) const {
  const Strain strain = strainOf(places);
  Eigen::Matrix2d stress = shear_ * (Eigen::Matrix2d::Identity() - strain.power * strain.inverse);
  if (curvature == Curvature::kConvex) stress = positivePart(stress);
  const Eigen::Matrix<double, 3, 2> dual = strain.F * strain.inverse;
  const Eigen::Matrix3d in_plane = dual * strain.F.transpose();
  const Eigen::Matrix3d f = dual * slopes_;  // a column per corner
  const Eigen::Matrix3d by_stress = area_ * slopes_.transpose() * stress * slopes_;
  const Eigen::Matrix3d by_metric = slopes_.transpose() * strain.inverse * slopes_;
  const double stiffness = area_ * shear_ * strain.power;
  Hessian hessian;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      hessian.block<3, 3>(3 * i, 3 * j) =
          by_stress(i, j) * Eigen::Matrix3d::Identity() +
          stiffness * (2.0 * exponent_ * f.col(i) * f.col(j).transpose() +
                       f.col(j) * f.col(i).transpose() + by_metric(i, j) * in_plane);
    }
  }
  return hessian;
}

}  // namespace robot_tissue
