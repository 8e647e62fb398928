// A block fixed at its bottom and a spherical probe above its top, in the middle.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "robot_tissue/core/method_names.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

constexpr double kSpacing = 0.005;
constexpr double kWidth = 0.06;
constexpr double kMiddle = 0.03;
constexpr double kTop = 0.04;
constexpr double kRadius = 0.01;

inline Box bottomOf(const Box& shape) {
  return {Vec3(shape.min().x() - 1.0, shape.min().y() - 1.0, shape.min().z() - 1e-6),
          Vec3(shape.max().x() + 1.0, shape.max().y() + 1.0, shape.min().z() + 1e-6)};
}

inline TissueConfig block(const std::string& model = "elastic", double spacing = kSpacing) {
  TissueConfig tissue;
  tissue.model = model;
  tissue.shape.max() = Vec3(kWidth, kWidth, kTop);
  tissue.spacing = spacing;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back(bottomOf(tissue.shape));
  return tissue;
}

// Two cells wide between y = 0 and kRidge, fixed at its bottom.
constexpr double kRidge = 0.01;     // m
constexpr double kRidgeTop = 0.03;  // m

inline TissueConfig ridge() {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.03, kRidge, kRidgeTop);
  tissue.spacing = kSpacing;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back(bottomOf(tissue.shape));
  return tissue;
}

inline SolverConfig methodOf(const std::string& model) {
  SolverConfig solver;
  solver.method = methodsFor(model).front();
  return solver;
}

inline ToolGeometry toolOf(const ToolShape& shape, const std::string& name = "probe") {
  ToolGeometry tool;
  tool.name = name;
  tool.links.push_back({name, {shape}});
  return tool;
}

// A sphere at `center` in the frame of its link.
inline ToolGeometry probe(const std::string& name = "probe", const Vec3& center = Vec3::Zero()) {
  ToolShape sphere;
  sphere.radius = kRadius;
  sphere.pose.translation() = center;
  return toolOf(sphere, name);
}

inline ToolShape boxOf(const Vec3& size, const Vec3& center = Vec3::Zero()) {
  ToolShape box;
  box.type = ToolShape::Type::kBox;
  box.size = size;
  box.pose.translation() = center;
  return box;
}

// Its lower end at the origin.
inline ToolShape uprightCylinder(double radius, double length) {
  ToolShape cylinder;
  cylinder.type = ToolShape::Type::kCylinder;
  cylinder.radius = radius;
  cylinder.length = length;
  cylinder.pose.translation().z() = 0.5 * length;
  return cylinder;
}

// Solid above its origin, or below it when it looks up.
inline ToolShape planeOf(bool looks_up) {
  ToolShape plane;
  plane.type = ToolShape::Type::kPlane;
  if (!looks_up) plane.pose.linear() = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
  return plane;
}

inline ToolGeometry withFriction(double friction, ToolGeometry tool) {
  tool.friction = friction;
  return tool;
}

// Frames of the tools' links with their origin at these points, not turned.
inline RobotPose at(const std::vector<Vec3>& origins) {
  RobotPose pose;
  for (const Vec3& origin : origins) {
    pose.links.push_back(Pose::Identity());
    pose.links.back().translation() = origin;
  }
  return pose;
}

// The probe's lowest point `depth` below the block's top, above the middle node (m).
inline RobotPose pressed(double depth, double x = kMiddle) {
  return at({Vec3(x, kMiddle, kTop + kRadius - depth)});
}

// Two plates that close on the ridge along y.
inline ToolGeometry ridgeGripper(const std::string& name, double close_gap, double open_gap) {
  ToolGeometry tool;
  tool.name = name;
  tool.role = toolRole("grasper");
  const Vec3 plate(0.016, 0.004, 0.01);
  tool.links = {{"left", {boxOf(plate, Vec3(0.0, -0.002, 0.0))}},
                {"right", {boxOf(plate, Vec3(0.0, 0.002, 0.0))}}};
  tool.grasp.close_gap = close_gap;
  tool.grasp.open_gap = open_gap;
  return tool;
}

// Where its links are, with the plates' inner faces `gap` apart around the ridge's upper part.
inline std::vector<Vec3> jawsOnRidge(double gap, double lift = 0.0) {
  return {Vec3(0.015, 0.5 * (kRidge - gap), kRidgeTop - 0.005 + lift),
          Vec3(0.015, 0.5 * (kRidge + gap), kRidgeTop - 0.005 + lift)};
}

// Brings the tools from one place to another in increments of the given length (m).
inline void walk(Pipeline& pipeline, const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                 double increment = 0.0005) {
  double way = 0.0;
  for (std::size_t i = 0; i < to.size(); ++i) way = std::max(way, (to[i] - from[i]).norm());
  const int count = static_cast<int>(std::ceil(way / increment - 1e-9));
  for (int step = 1; step <= count; ++step) {
    std::vector<Vec3> between;
    for (std::size_t i = 0; i < to.size(); ++i) {
      between.push_back(from[i] + (to[i] - from[i]) * step / count);
    }
    pipeline.step(at(between));
  }
}

// Walks the probe from one depth to another (m).
inline void walk(Pipeline& pipeline, double from, double to, double increment = 0.0005) {
  walk(pipeline, {pressed(from).links.front().translation()},
       {pressed(to).links.front().translation()}, increment);
}

inline double greatestDisplacement(const Tissue& tissue) {
  double greatest = 0.0;
  for (const Vec3& moved : tissue.state().displacement) greatest = std::max(greatest, moved.norm());
  return greatest;
}

// L2 over the nodes, of the second.
inline double relativeDifference(const Tissue& one, const Tissue& other) {
  double difference = 0.0, size = 0.0;
  for (std::size_t node = 0; node < one.state().displacement.size(); ++node) {
    const Vec3& moved = other.state().displacement[node];
    difference += (one.state().displacement[node] - moved).squaredNorm();
    size += moved.squaredNorm();
  }
  return std::sqrt(difference / size);
}

// What presses what: the models, and how tools hold on to the tissue.
struct Press {
  std::string name;
  std::string model;
  ToolConfig::Patch patch = ToolConfig::Patch::kConforming;

  ToolGeometry tool() const {
    ToolGeometry tool = probe();
    tool.patch = patch;
    return tool;
  }
  // Depth of a tool in the surface that is none (m).
  double hair() const { return (patch == ToolConfig::Patch::kRigid ? 0.01 : 0.05) * kSpacing; }
};

inline const Press kElastic = {"Elastic", "elastic"};
inline const Press kElasticRigid = {"ElasticRigid", "elastic", ToolConfig::Patch::kRigid};
inline const Press kSixSpring = {"SixSpring", "six_spring", ToolConfig::Patch::kRigid};

class PressedBlock : public ::testing::TestWithParam<Press> {
 protected:
  Pipeline pipeline_{block(GetParam().model), methodOf(GetParam().model), {GetParam().tool()}};

  static Pipeline anotherPipeline() {
    return {block(GetParam().model), methodOf(GetParam().model), {GetParam().tool()}};
  }
  const ToolReport& tool() const { return pipeline_.report().tools.front(); }
};

}  // namespace robot_tissue
