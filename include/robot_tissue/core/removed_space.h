// The space in which tissue is removed, as the shape is then (m).
#pragma once

#include <functional>
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

// Any other, such as what the shapes of a tool cover.
struct CoveredSpace {
  Box bounds;                               // all of it is in there
  std::function<bool(const Vec3&)> covers;  // of a point in the tissue's frame
};

using RemovedSpace = std::variant<PlacedBox, Sphere, CoveredSpace>;

inline bool holds(const PlacedBox& placed, const Vec3& point) {
  return placed.box.contains(placed.tissue_T_box.inverse() * point);
}
inline bool holds(const Sphere& sphere, const Vec3& point) {
  return (point - sphere.center).squaredNorm() <= sphere.radius * sphere.radius;
}
inline bool holds(const CoveredSpace& space, const Vec3& point) {
  return space.bounds.contains(point) && space.covers(point);
}
inline bool holds(const RemovedSpace& space, const Vec3& point) {
  return std::visit([&](const auto& each) { return holds(each, point); }, space);
}

}  // namespace robot_tissue
