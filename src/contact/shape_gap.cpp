#include "shape_gap.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <vector>

#include "tuning.h"

namespace robot_tissue {
namespace {

using Type = ToolShape::Type;
using FclMesh = fcl::BVHModel<fcl::OBBRSSd>;

// The tolerances of libccd are absolute and made for shapes about one unit wide: with 1, gaps would
// be wrong by micrometers.

std::unique_ptr<fcl::CollisionGeometryd> makeMesh(const ToolMesh& mesh) {
  auto model = std::make_unique<FclMesh>();
  std::vector<Vec3> vertices;
  for (const Vec3& vertex : mesh.vertices()) vertices.push_back(tuning::kUnitsPerM * vertex);
  std::vector<fcl::Triangle> triangles;
  for (const MeshTriangle& t : mesh.triangles())
    triangles.emplace_back(at(t[0]), at(t[1]), at(t[2]));
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

std::unique_ptr<fcl::CollisionGeometryd> makeGeometry(const CollisionShape& shape) {
  const ToolShape& measures = shape.measures();
  switch (measures.type) {
    case Type::kBox:
      return std::make_unique<fcl::Boxd>(tuning::kUnitsPerM * measures.size);
    case Type::kCylinder:
      return std::make_unique<fcl::Cylinderd>(tuning::kUnitsPerM * measures.radius,
                                              tuning::kUnitsPerM * measures.length);
    case Type::kMesh:
      return makeMesh(shape.mesh());
    case Type::kSphere:
    case Type::kPlane:
      break;
  }
  return nullptr;
}

bool isSphere(const PlacedShape& placed) { return placed.shape->measures().type == Type::kSphere; }

// Of a sphere: the other shape's distance from its center, less its radius.
double gapOfSphere(const PlacedShape& sphere, const PlacedShape& other) {
  const Vec3 center = other.shape_T_tissue * sphere.tissue_T_shape.translation();
  return other.shape->distance(center).value - sphere.shape->measures().radius -
         sphere.shape->padding();
}

// Of a plane: the height of the other shape's lowest point over it.
double gapOverPlane(const PlacedShape& plane, const GapSide& other) {
  const Pose plane_T_other = plane.shape_T_tissue * other.placed->tissue_T_shape;
  const double padding = plane.shape->padding() + other.placed->shape->padding();
  if (other.placed->shape->isPlane()) {
    const bool faces = (plane_T_other.linear().col(2) + Vec3::UnitZ()).norm() < 1e-9;
    return faces ? plane_T_other.translation().z() - padding : 0.0;
  }
  if (!other.placed->shape->isMesh()) {
    const Vec3 down = -plane_T_other.linear().transpose().col(2);
    return (plane_T_other * other.placed->shape->farthest(down)).z() - plane.shape->padding();
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : other.placed->shape->mesh().vertices()) {
    lowest = std::min(lowest, (plane_T_other * vertex).z());
  }
  return lowest - padding;
}

// A mesh that is wholly inside the other shape meets none of its faces.
bool isWithin(const PlacedShape& inner, const PlacedShape& outer) {
  const Vec3 point = inner.shape->isMesh() ? inner.shape->mesh().vertices().front() : Vec3::Zero();
  return outer.shape->distanceNear(outer.shape_T_tissue * (inner.tissue_T_shape * point), 0.0)
      .has_value();
}

fcl::Transform3d fclPlace(const PlacedShape& placed) {
  fcl::Transform3d place = placed.tissue_T_shape;
  place.translation() *= tuning::kUnitsPerM;
  return place;
}

// Of the points of one from the other: where FCL gives up.
double gapOfPoints(const GapSide& points, const GapSide& shape) {
  double least = std::numeric_limits<double>::infinity();
  const Pose shape_T_points = shape.placed->shape_T_tissue * points.placed->tissue_T_shape;
  for (const Vec3& point : *points.points) {
    least = std::min(least, shape.placed->shape->distance(shape_T_points * point).value);
  }
  return least;
}

}  // namespace

struct GapShape::FclObject {
  std::unique_ptr<fcl::CollisionGeometryd> geometry;
};

GapShape::GapShape(const CollisionShape& shape)
    : object_(std::make_unique<FclObject>(FclObject{makeGeometry(shape)})) {
  if (object_->geometry) object_->geometry->computeLocalAABB();
}
GapShape::~GapShape() = default;
GapShape::GapShape(GapShape&&) noexcept = default;

namespace {

// FCL looks for what is nearer than the result has it.
std::optional<double> gapByFcl(const GapSide& a, const GapSide& b, double reach) {
  const double padding = a.placed->shape->padding() + b.placed->shape->padding();
  const fcl::DistanceRequestd request(false, false, 0.0, 0.0, 1e-9);
  fcl::DistanceResultd result;
  const double beyond = reach + padding + tuning::kBeyondReach;
  if (std::isfinite(beyond)) result.min_distance = tuning::kUnitsPerM * beyond;
  try {
    fcl::distance(a.shape->object()->geometry.get(), fclPlace(*a.placed),
                  b.shape->object()->geometry.get(), fclPlace(*b.placed), request, result);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  const double gap = result.min_distance / tuning::kUnitsPerM;
  if (!std::isfinite(gap) || std::abs(gap) > 1e6) return std::nullopt;
  return std::max(0.0, gap) - padding;
}

}  // namespace

double gapBetween(const GapSide& a, const GapSide& b, double reach) {
  const double between_boxes = a.placed->bounds.exteriorDistance(b.placed->bounds);
  if (between_boxes > reach + tuning::kBeyondReach) return between_boxes;
  double gap = 0.0;
  if (a.placed->shape->isPlane()) {
    gap = gapOverPlane(*a.placed, b);
  } else if (b.placed->shape->isPlane()) {
    gap = gapOverPlane(*b.placed, a);
  } else if (isSphere(*a.placed)) {
    gap = gapOfSphere(*a.placed, *b.placed);
  } else if (isSphere(*b.placed)) {
    gap = gapOfSphere(*b.placed, *a.placed);
  } else if (!isWithin(*a.placed, *b.placed) && !isWithin(*b.placed, *a.placed)) {
    const auto found = gapByFcl(a, b, reach);
    gap = found ? *found : std::min(gapOfPoints(a, b), gapOfPoints(b, a));
  }
  return std::max(0.0, gap);
}

}  // namespace robot_tissue
