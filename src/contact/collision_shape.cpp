#include "collision_shape.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

namespace robot_tissue {
namespace {

// A mesh with less volume than this share of its hull's is reported as not convex.
constexpr double kConvexShare = 0.95;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", value);
  return text;
}

double positive(double value, const char* what, const std::string& owner) {
  if (value > 0.0 && std::isfinite(value)) return value;
  throw InputError(owner + ": " + what + " is " + number(value) + "; allowed is > 0 (m)");
}

std::unique_ptr<fcl::Sphered> makeProbe(double radius) {
  auto probe = std::make_unique<fcl::Sphered>(radius);
  probe->computeLocalAABB();
  return probe;
}

std::unique_ptr<fcl::Convexd> makeConvex(const ConvexHull& hull, double fcl_units_per_m) {
  auto vertices = std::make_shared<std::vector<Vec3>>();
  for (const Vec3& vertex : hull.vertices) vertices->push_back(vertex * fcl_units_per_m);
  auto faces = std::make_shared<std::vector<int>>();
  for (const HullFace& face : hull.faces) {
    faces->push_back(3);
    faces->insert(faces->end(), face.vertices.begin(), face.vertices.end());
  }
  return std::make_unique<fcl::Convexd>(vertices, static_cast<int>(hull.faces.size()), faces);
}

fcl::Transform3d movedTo(const Vec3& point) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.translation() = point;
  return transform;
}

}  // namespace

struct CollisionShape::FclObjects {
  std::unique_ptr<fcl::CollisionGeometryd> shape;
  std::unique_ptr<fcl::Sphered> probe;  // a surface point; its radius is the padding
  // The tolerances of libccd are absolute and made for shapes about one unit wide.
  double units_per_m = 1.0;
};

CollisionShape::~CollisionShape() = default;
CollisionShape::CollisionShape(CollisionShape&&) noexcept = default;

CollisionShape::CollisionShape(const ToolShape& shape, double padding, const std::string& owner,
                               std::vector<std::string>& warnings)
    : pose_in_link_(shape.pose), padding_(padding), fcl_(std::make_unique<FclObjects>()) {
  if (!(padding >= 0.0 && std::isfinite(padding))) {
    throw InputError(owner + ": padding is " + number(padding) + "; allowed is >= 0 (m)");
  }
  if (!shape.pose.matrix().allFinite()) {
    throw InputError(owner + ": its pose has a number that is not finite");
  }
  if (shape.type == ToolShape::Type::kMesh) {
    buildHull(shape, owner, warnings);
  } else {
    buildPrimitive(shape, owner);
  }
  fcl_->probe = makeProbe(padding * fcl_->units_per_m);
  fcl_->shape->computeLocalAABB();
  thickness_ += 2.0 * padding;
  const Vec3 reach = Vec3::Constant(padding);
  bounds_.min = fcl_->shape->aabb_local.min_ / fcl_->units_per_m - reach;
  bounds_.max = fcl_->shape->aabb_local.max_ / fcl_->units_per_m + reach;
}

void CollisionShape::buildPrimitive(const ToolShape& shape, const std::string& owner) {
  if (shape.type == ToolShape::Type::kBox) {
    for (int axis = 0; axis < 3; ++axis) positive(shape.size[axis], "box size", owner);
    fcl_->shape = std::make_unique<fcl::Boxd>(shape.size);
    thickness_ = shape.size.minCoeff();
  } else if (shape.type == ToolShape::Type::kCylinder) {
    const double radius = positive(shape.radius, "cylinder radius", owner);
    const double length = positive(shape.length, "cylinder length", owner);
    fcl_->shape = std::make_unique<fcl::Cylinderd>(radius, length);
    thickness_ = std::min(2.0 * radius, length);
  } else {
    const double radius = positive(shape.radius, "sphere radius", owner);
    fcl_->shape = std::make_unique<fcl::Sphered>(radius);
    thickness_ = 2.0 * radius;
  }
}

void CollisionShape::buildHull(const ToolShape& shape, const std::string& owner,
                               std::vector<std::string>& warnings) {
  hull_ = loadHull(shape.resource, shape.scale, owner);
  const double share = hull_->mesh_volume / hull_->volume;
  if (share < kConvexShare) {
    warnings.push_back(owner + ": mesh '" + shape.resource + "' is not convex and fills " +
                       number(std::round(100.0 * share)) +
                       " % of its convex hull; the hull is what touches");
  }
  thickness_ = hull_->thickness();
  fcl_->units_per_m = 1.0 / thickness_;
  fcl_->shape = makeConvex(*hull_, fcl_->units_per_m);
}

std::optional<WayOut> CollisionShape::wayOut(const Vec3& point) const {
  // Written so that a point that is not finite is outside.
  const bool in_bounds =
      (point.array() >= bounds_.min.array()).all() && (point.array() <= bounds_.max.array()).all();
  if (!in_bounds) return std::nullopt;
  if (!hull_) return wayOutOfPrimitive(point);
  // libccd tells overlap with a polytope well, but its depth is not the least one: the hull's
  // faces give that.
  if (!overlaps(point)) return std::nullopt;
  return hull_->wayOut(point, padding_);
}

bool CollisionShape::overlaps(const Vec3& point) const {
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  try {
    fcl::collide(fcl_->probe.get(), movedTo(point * fcl_->units_per_m), fcl_->shape.get(),
                 fcl::Transform3d::Identity(), request, result);
  } catch (const std::exception&) {
    return true;  // FCL gives up on degenerate positions: left to the hull's faces
  }
  return result.isCollision();
}

// FCL has closed formulas for a sphere against a sphere, a box and a cylinder.
std::optional<WayOut> CollisionShape::wayOutOfPrimitive(const Vec3& point) const {
  const fcl::CollisionRequestd request(1, true);
  fcl::CollisionResultd result;
  fcl::collide(fcl_->probe.get(), movedTo(point), fcl_->shape.get(), fcl::Transform3d::Identity(),
               request, result);
  if (!result.isCollision()) return std::nullopt;
  const fcl::Contactd& contact = result.getContact(0);
  const double depth = contact.penetration_depth;
  if (!(depth > 0.0 && std::isfinite(depth))) return std::nullopt;
  // FCL's normal goes from the probe into the shape; it is zero at the center of a sphere.
  WayOut out{depth, -contact.normal};
  const double length = out.normal.norm();
  out.normal = length > 0.5 ? Vec3(out.normal / length) : Vec3::Zero();
  return out;
}

}  // namespace robot_tissue
