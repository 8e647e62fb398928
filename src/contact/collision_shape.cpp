#include "collision_shape.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace robot_tissue {
namespace {

using Type = ToolShape::Type;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", value);
  return text;
}

// Those of a scene are within narrower ranges, by the tissue's size; a URDF's come unchecked (m).
constexpr double kSmallest = 1e-9;
constexpr double kLargest = 1e6;

double positive(double value, const char* what, const std::string& owner) {
  if (value >= kSmallest && value <= kLargest) return value;
  throw InputError(owner + ": " + what + " is " + number(value) + "; allowed is > 0, from " +
                   number(kSmallest) + " to " + number(kLargest) + " (m)");
}

}  // namespace

CollisionShape::CollisionShape(const ToolShape& shape, const std::string& owner,
                               std::vector<std::string>& warnings)
    : shape_(shape) {
  if (!(shape.padding >= 0.0 && shape.padding <= kLargest)) {
    throw InputError(owner + ": padding is " + number(shape.padding) +
                     "; allowed is >= 0 (m), up to " + number(kLargest));
  }
  if (!shape.pose.matrix().allFinite()) {
    throw InputError(owner + ": its pose has a number that is not finite");
  }
  if (!(shape.pose.translation().cwiseAbs().maxCoeff() <= kLargest)) {
    throw InputError(owner + ": it is " + number(shape.pose.translation().norm()) +
                     " m from its link; allowed is up to " + number(kLargest));
  }
  if (shape.type == Type::kMesh) {
    measureMesh(owner, warnings);
  } else {
    measurePrimitive(owner);
  }
  thickness_ += 2.0 * shape.padding;
  bounds_ = grownBy(shape.padding, bounds_);
}

void CollisionShape::measurePrimitive(const std::string& owner) {
  if (shape_.type == Type::kPlane) {
    thickness_ = kInfinity;
    bounds_ = {Vec3::Constant(-kInfinity), Vec3(kInfinity, kInfinity, 0.0)};
    return;
  }
  Vec3 reach;
  if (shape_.type == Type::kBox) {
    for (int axis = 0; axis < 3; ++axis) positive(shape_.size[axis], "box size", owner);
    reach = 0.5 * shape_.size;
  } else if (shape_.type == Type::kCylinder) {
    const double radius = positive(shape_.radius, "cylinder radius", owner);
    reach = Vec3(radius, radius, 0.5 * positive(shape_.length, "cylinder length", owner));
  } else {
    reach = Vec3::Constant(positive(shape_.radius, "sphere radius", owner));
  }
  thickness_ = 2.0 * reach.minCoeff();
  bounds_ = {-reach, reach};
}

void CollisionShape::measureMesh(const std::string& owner, std::vector<std::string>& warnings) {
  mesh_ = std::make_shared<const ToolMesh>(shape_.resource, shape_.scale, owner, warnings);
  thickness_ = mesh_->thickness();
  bounds_ = mesh_->bounds();
  positive((bounds_.max() - bounds_.min()).maxCoeff(), "size of its mesh", owner);
}

SignedDistance CollisionShape::unpadded(const Vec3& point) const {
  switch (shape_.type) {
    case Type::kSphere:
      return distanceToSphere(shape_.radius, point);
    case Type::kBox:
      return distanceToBox(0.5 * shape_.size, point);
    case Type::kCylinder:
      return distanceToCylinder(shape_.radius, 0.5 * shape_.length, point);
    case Type::kPlane:
      return distanceToPlane(point);
    case Type::kMesh:
      break;
  }
  return mesh_->distance(point, kInfinity).value_or(SignedDistance{kInfinity, Vec3::Zero()});
}

SignedDistance CollisionShape::distance(const Vec3& point) const {
  SignedDistance distance = unpadded(point);
  distance.value -= shape_.padding;
  return distance;
}

SignedDistance CollisionShape::distanceWithin(const Vec3& point, double bound) const {
  if (!isMesh()) return distance(point);
  SignedDistance distance = mesh_->distanceWithin(point, bound + shape_.padding);
  distance.value -= shape_.padding;
  return distance;
}

// The mesh answers points inside it at any depth, those outside within the reach only.
std::optional<SignedDistance> CollisionShape::distanceNear(const Vec3& point, double reach,
                                                           double bound) const {
  if (!grownBy(reach, bounds_).contains(point) || !point.allFinite()) return std::nullopt;
  if (!isMesh()) {
    const SignedDistance found = distance(point);
    return found.value > reach ? std::nullopt : std::optional<SignedDistance>(found);
  }
  auto found = mesh_->distance(point, reach + shape_.padding, bound + shape_.padding);
  if (found) found->value -= shape_.padding;
  return found;
}

Vec3 CollisionShape::farthest(const Vec3& direction) const {
  Vec3 corner = Vec3::Zero();
  if (shape_.type == Type::kSphere) {
    corner = shape_.radius * direction;
  } else if (shape_.type == Type::kBox) {
    for (int k = 0; k < 3; ++k) corner[k] = std::copysign(0.5 * shape_.size[k], direction[k]);
  } else {
    const double radial = direction.head<2>().norm();
    if (radial > 0.0) corner.head<2>() = direction.head<2>() * (shape_.radius / radial);
    corner.z() = std::copysign(0.5 * shape_.length, direction.z());
  }
  return corner + shape_.padding * direction;
}

}  // namespace robot_tissue
