#include "membrane/pressed_triangle.h"

#include <Eigen/Geometry>

namespace robot_tissue {

double PressedTriangle::energy(const Corners& places) const {
  const Vec3 a = places[0] - origin_, b = places[1] - origin_, c = places[2] - origin_;
  return -pressure_ / 6.0 * a.dot(b.cross(c));
}

PressedTriangle::Corners PressedTriangle::gradient(const Corners& places) const {
  const Vec3 a = places[0] - origin_, b = places[1] - origin_, c = places[2] - origin_;
  const double factor = -pressure_ / 6.0;
  return {factor * b.cross(c), factor * c.cross(a), factor * a.cross(b)};
}

// d(b x c) = db x c + b x dc
PressedTriangle::Hessian PressedTriangle::hessian(const Corners& places,
                                                  Curvature curvature) const {
  Hessian hessian = Hessian::Zero();
  if (curvature == Curvature::kConvex) return hessian;
  for (int corner = 0; corner < 3; ++corner) {
    const int next = (corner + 1) % 3, last = (corner + 2) % 3;
    const Eigen::Matrix3d cross = -pressure_ / 6.0 * crossMatrix(places[at(last)] - origin_);
    hessian.block<3, 3>(3 * corner, 3 * next) = -cross;
    hessian.block<3, 3>(3 * next, 3 * corner) = cross;
  }
  return hessian;
}

}  // namespace robot_tissue
