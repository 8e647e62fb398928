#include "shape_indenter.h"

#include <cmath>
#include <utility>
#include <vector>

#include "tuning.h"

namespace robot_tissue {
namespace {

// An upright prism on a polygon around the z axis, counter-clockwise (m).
TriangleMesh prismOn(const std::vector<Vec3>& corners, double half_height) {
  TriangleMesh mesh;
  const int count = static_cast<int>(corners.size());
  for (const double z : {-half_height, half_height}) {
    for (const Vec3& corner : corners) mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  }
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    mesh.triangles.push_back({i, next, count + next});
    mesh.triangles.push_back({i, count + next, count + i});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({count, count + i, count + next});
  }
  return mesh;
}

TriangleMesh boxOf(const Vec3& half) {
  return prismOn({Vec3(-half.x(), -half.y(), 0.0), Vec3(half.x(), -half.y(), 0.0),
                  Vec3(half.x(), half.y(), 0.0), Vec3(-half.x(), half.y(), 0.0)},
                 half.z());
}

TriangleMesh cylinderOf(double radius, double half_length) {
  const double angle = 2.0 * M_PI / tuning::kSidesOfCylinder;
  const double reach = radius * std::sqrt(angle / std::sin(angle));
  std::vector<Vec3> corners;
  for (int i = 0; i < tuning::kSidesOfCylinder; ++i) {
    corners.emplace_back(reach * std::cos(i * angle), reach * std::sin(i * angle), 0.0);
  }
  return prismOn(corners, half_length);
}

TriangleMesh paddedMesh(const CollisionShape& shape) {
  TriangleMesh mesh{shape.mesh().vertices(), shape.mesh().triangles()};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] += shape.padding() * shape.mesh().vertexNormals()[i];
  }
  return mesh;
}

}  // namespace

std::shared_ptr<const Indenter> indenterOf(const CollisionShape& shape) {
  const ToolShape& measures = shape.measures();
  switch (measures.type) {
    case ToolShape::Type::kBox:
      return std::make_shared<const Indenter>(
          boxOf(0.5 * measures.size + Vec3::Constant(shape.padding())));
    case ToolShape::Type::kCylinder:
      return std::make_shared<const Indenter>(
          cylinderOf(measures.radius + shape.padding(), 0.5 * measures.length + shape.padding()));
    case ToolShape::Type::kMesh:
      return std::make_shared<const Indenter>(paddedMesh(shape));
    case ToolShape::Type::kSphere:
      return std::make_shared<const Indenter>(Indenter::ball(measures.radius + shape.padding()));
    default:
      return nullptr;
  }
}

}  // namespace robot_tissue
