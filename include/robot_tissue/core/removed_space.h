// The space in which tissue is removed, as the shape is then (m).
#pragma once

#include <variant>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct Sphere {
  Vec3 center = Vec3::Zero();  // tissue frame
  double radius = 0.0;
};

struct PlacedBox {
  Box box;  // in its own frame
  Pose tissue_T_box = Pose::Identity();
};

using RemovedSpace = std::variant<PlacedBox, Sphere>;

inline bool holds(const PlacedBox& placed, const Vec3& point) {
  return placed.box.contains(placed.tissue_T_box.inverse() * point);
}
inline bool holds(const Sphere& sphere, const Vec3& point) {
  return (point - sphere.center).squaredNorm() <= sphere.radius * sphere.radius;
}
inline bool holds(const RemovedSpace& space, const Vec3& point) {
  return std::visit([&](const auto& each) { return holds(each, point); }, space);
}

}  // namespace robot_tissue
