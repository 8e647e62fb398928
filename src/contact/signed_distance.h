// Signed distances of primitive shapes, each in its own frame, by closed formulas (own).
#pragma once

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct SignedDistance {
  double value = 0.0;         // m, < 0 inside
  Vec3 slope = Vec3::Zero();  // unit, away from the shape; zero where every way is as good
};

SignedDistance distanceToSphere(double radius, const Vec3& point);
SignedDistance distanceToBox(const Vec3& half_size, const Vec3& point);
// Axis along z.
SignedDistance distanceToCylinder(double radius, double half_length, const Vec3& point);
// Solid below z = 0.
SignedDistance distanceToPlane(const Vec3& point);

}  // namespace robot_tissue
