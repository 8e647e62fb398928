#include "robot_tissue/core/cell_fill.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace robot_tissue {

Eigen::Matrix3d CellFill::covariance() const { return products - centroid * centroid.transpose(); }

// Of a layer that reaches r to both sides the variance is r^2 / 3.
double CellFill::reachAlong(const Vec3& direction) const {
  return std::sqrt(3.0 * std::max(0.0, direction.dot(covariance() * direction)));
}

// N = product over the axes of (1/2 + s_a x_a), s_a = 1 at the high end, else -1.
double CellFill::cornerShare(int corner) const {
  Vec3 side;
  for (int axis = 0; axis < 3; ++axis) side[axis] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
  const double pairs = side[0] * side[1] * products(0, 1) + side[0] * side[2] * products(0, 2) +
                       side[1] * side[2] * products(1, 2);
  const double all = side.prod() * triple;
  return 0.125 + 0.25 * side.dot(centroid) + 0.5 * pairs + all;
}

void FillIntegrals::add(const Vec3& point, double with_volume) {
  volume += with_volume;
  first += with_volume * point;
  second += with_volume * point * point.transpose();
  triple += with_volume * point.prod();
}

FillIntegrals& FillIntegrals::operator+=(const FillIntegrals& other) {
  volume += other.volume;
  first += other.first;
  second += other.second;
  triple += other.triple;
  return *this;
}

FillIntegrals FillIntegrals::scaledBy(double factor) const {
  return {factor * volume, factor * first, factor * second, factor * triple};
}

FillIntegrals integralsOf(const CellFill& fill) {
  return {fill.share, fill.share * fill.centroid, fill.share * fill.products,
          fill.share * fill.triple};
}

CellFill fillOf(const FillIntegrals& integrals) {
  const double inverse = 1.0 / integrals.volume;
  CellFill fill = {integrals.volume, inverse * integrals.first, inverse * integrals.second,
                   inverse * integrals.triple};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(fill.covariance());
  fill.spread = solver.eigenvalues();
  fill.axes = solver.eigenvectors();
  return fill;
}

FillIntegrals octantIntegrals(std::uint8_t corners) {
  constexpr int kOctants = 8;
  FillIntegrals sum;
  for (int corner = 0; corner < kOctants; ++corner) {
    if ((corners >> corner & 1) == 0) continue;
    Vec3 middle;
    for (int axis = 0; axis < 3; ++axis) middle[axis] = (corner >> axis & 1) != 0 ? 0.25 : -0.25;
    sum.add(middle, 1.0 / kOctants);
    // About its own middle a cube of side 1/2 has the second moment 1/48 of its volume.
    sum.second.diagonal().array() += 1.0 / kOctants / 48.0;
  }
  return sum;
}

}  // namespace robot_tissue
