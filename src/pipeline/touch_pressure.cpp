#include "robot_tissue/pipeline/touch_pressure.h"

#include <array>
#include <limits>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/triangle_point.h"

namespace robot_tissue {
namespace {

Corners deformedCorners(const Tissue& tissue, const MeshTriangle& triangle) {
  const std::vector<Vec3>& vertices = tissue.vertices();
  return {vertices[at(triangle[0])], vertices[at(triangle[1])], vertices[at(triangle[2])]};
}

std::vector<ToolTouch> pressingTouches(const Pipeline& pipeline) {
  std::vector<ToolTouch> pressing;
  for (std::size_t tool = 0; tool < pipeline.tools().size() && pipeline.pose(); ++tool) {
    for (const ToolTouch& touch : pipeline.touchesOf(tool)) {
      if (touch.normal_force > 0.0) pressing.push_back(touch);
    }
  }
  return pressing;
}

struct BoxedTriangle {
  MeshTriangle corners{};
  Box box;  // deformed
};

// Whose box reaches into the box around the touches: each of these is on one of them.
std::vector<BoxedTriangle> trianglesAround(const std::vector<ToolTouch>& touches,
                                           const Tissue& tissue) {
  Box around;
  for (const ToolTouch& touch : touches) around.extend(touch.point);
  const Box near = grownBy(tissue.lattice().spacing(), around);
  std::vector<BoxedTriangle> triangles;
  for (const MeshTriangle& triangle : tissue.surface().triangles) {
    Box box;
    for (const int vertex : triangle) box.extend(tissue.vertices()[at(vertex)]);
    if (box.intersects(near)) triangles.push_back({triangle, box});
  }
  return triangles;
}

// Shares the force (N) among the corners of the triangle that the point is on.
void shareForce(const Tissue& tissue, const std::vector<BoxedTriangle>& triangles,
                const Vec3& point, double force, std::vector<double>& forces) {
  double nearest = std::numeric_limits<double>::infinity();
  MeshTriangle found{};
  Vec3 shares = Vec3::Zero();
  for (const auto& [triangle, box] : triangles) {
    if (box.squaredExteriorDistance(point) >= nearest * nearest) continue;
    const Corners corners = deformedCorners(tissue, triangle);
    const Vec3 weights = nearestInTriangle(point, corners);
    const double distance = (pointOf(corners, weights) - point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    found = triangle;
    shares = weights;
  }
  for (int k = 0; k < 3; ++k) forces[at(found[at(k)])] += shares[k] * force;
}

}  // namespace

std::vector<double> touchPressures(const Pipeline& pipeline) {
  const Tissue& tissue = pipeline.tissue();
  std::vector<double> values(tissue.vertices().size(), 0.0);
  const std::vector<ToolTouch> touches = pressingTouches(pipeline);
  if (touches.empty()) return values;
  const std::vector<BoxedTriangle> near = trianglesAround(touches, tissue);
  for (const ToolTouch& touch : touches) {
    shareForce(tissue, near, touch.point, touch.normal_force, values);
  }
  std::vector<double> areas(values.size(), 0.0);
  for (const MeshTriangle& triangle : tissue.surface().triangles) {
    const double third = doubleArea(tissue.vertices(), triangle).norm() / 6.0;
    for (const int vertex : triangle) areas[at(vertex)] += third;
  }
  for (std::size_t vertex = 0; vertex < values.size(); ++vertex) {
    if (areas[vertex] > 0.0) values[vertex] /= areas[vertex];
  }
  return values;
}

}  // namespace robot_tissue
