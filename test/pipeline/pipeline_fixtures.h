// A block fixed at its bottom and a spherical probe above its top, in the middle.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "robot_tissue/core/registry.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

constexpr double kSpacing = 0.005;
constexpr double kTop = 0.05;
constexpr double kRadius = 0.01;

inline TissueConfig block(const std::string& model = "elastic") {
  TissueConfig tissue;
  tissue.model = model;
  tissue.shape.max = Vec3(0.1, 0.1, kTop);
  tissue.spacing = kSpacing;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back({Vec3(-1, -1, -1e-6), Vec3(1, 1, 1e-6)});
  return tissue;
}

inline SolverConfig methodOf(const std::string& model) {
  SolverConfig solver;
  solver.method = methodsFor(model).front();
  return solver;
}

// A sphere at `center` in the frame of its link.
inline ToolGeometry probe(const std::string& name = "probe", const Vec3& center = Vec3::Zero()) {
  ToolShape sphere;
  sphere.radius = kRadius;
  sphere.pose.translation() = center;
  return {name, name, 0.0, {sphere}};
}

// Tool frames with their origin at these points, not turned.
inline RobotPose at(const std::vector<Vec3>& origins) {
  RobotPose pose;
  for (const Vec3& origin : origins) {
    pose.tools.push_back(Pose::Identity());
    pose.tools.back().translation() = origin;
  }
  return pose;
}

// The probe's lowest point `depth` below the block's top, above the middle node (m).
inline RobotPose pressed(double depth, double x = 0.05) {
  return at({Vec3(x, 0.05, kTop + kRadius - depth)});
}

// Walks the probe from one depth to another in increments of the given length (m).
inline void walk(Pipeline& pipeline, double from, double to, double increment = 0.00025) {
  const int count = static_cast<int>(std::ceil(std::abs(to - from) / increment - 1e-9));
  for (int i = 1; i <= count; ++i) pipeline.step(pressed(from + (to - from) * i / count));
}

inline double greatestDisplacement(const Tissue& tissue) {
  double greatest = 0.0;
  for (const Vec3& moved : tissue.state().displacement) greatest = std::max(greatest, moved.norm());
  return greatest;
}

}  // namespace robot_tissue
