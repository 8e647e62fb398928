#include "signed_distance.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

Vec3 unitOrZero(const Vec3& v, double length) { return length > 0.0 ? Vec3(v / length) : v; }

}  // namespace

SignedDistance distanceToSphere(double radius, const Vec3& point) {
  const double length = point.norm();
  return {length - radius, unitOrZero(point, length)};
}

SignedDistance distanceToBox(const Vec3& half_size, const Vec3& point) {
  const Vec3 beyond = point.cwiseAbs() - half_size;
  int axis = 0;
  const double most = beyond.maxCoeff(&axis);
  SignedDistance distance;
  if (most <= 0.0) {
    distance.value = most;
    distance.slope[axis] = std::copysign(1.0, point[axis]);
    return distance;
  }
  const Vec3 away = beyond.cwiseMax(0.0);
  distance.value = away.norm();
  for (int k = 0; k < 3; ++k) {
    distance.slope[k] = std::copysign(away[k], point[k]) / distance.value;
  }
  return distance;
}

SignedDistance distanceToCylinder(double radius, double half_length, const Vec3& point) {
  const double from_axis = std::hypot(point.x(), point.y());
  // On the axis one radial way is as good as another.
  const Vec3 radial = from_axis > 0.0 ? Vec3(point.x() / from_axis, point.y() / from_axis, 0.0)
                                      : Vec3(Vec3::UnitX());
  const Vec3 axial(0.0, 0.0, std::copysign(1.0, point.z()));
  const double beyond_side = from_axis - radius;
  const double beyond_cap = std::abs(point.z()) - half_length;
  if (beyond_side <= 0.0 || beyond_cap <= 0.0) {
    return beyond_side > beyond_cap ? SignedDistance{beyond_side, radial}
                                    : SignedDistance{beyond_cap, axial};
  }
  const double value = std::hypot(beyond_side, beyond_cap);
  return {value, (beyond_side * radial + beyond_cap * axial) / value};
}

SignedDistance distanceToPlane(const Vec3& point) { return {point.z(), Vec3::UnitZ()}; }

}  // namespace robot_tissue
