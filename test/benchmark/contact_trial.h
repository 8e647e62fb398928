// What the studies of contact share: blocks, tools, and sums over the touches of a tool.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

constexpr double kYoung = 1e4;     // Pa
constexpr double kPoisson = 0.45;  // of all blocks

inline double argument(int argc, char** argv, int index, double otherwise) {
  return argc > index ? std::atof(argv[index]) : otherwise;
}

// From the origin to `extent` (m), held at its bottom when `fixed`.
inline TissueConfig blockOf(const Vec3& extent, double spacing, bool fixed = true) {
  TissueConfig tissue;
  tissue.shape = {Vec3::Zero(), extent};
  tissue.spacing = spacing;
  tissue.material.young_modulus = kYoung;
  tissue.material.poisson_ratio = kPoisson;
  if (fixed) tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  return tissue;
}

inline SolverConfig solverOf(const std::string& method, double tolerance) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = tolerance;
  return solver;
}

inline ToolShape sphereOf(double radius) {
  ToolShape shape;
  shape.type = ToolShape::Type::kSphere;
  shape.radius = radius;
  return shape;
}

inline ToolShape boxOf(const Vec3& size) {
  ToolShape shape;
  shape.type = ToolShape::Type::kBox;
  shape.size = size;
  return shape;
}

inline ToolShape cylinderOf(double radius, double length) {
  ToolShape shape;
  shape.type = ToolShape::Type::kCylinder;
  shape.radius = radius;
  shape.length = length;
  return shape;
}

inline ToolGeometry toolOf(const std::string& name, const ToolShape& shape, double friction) {
  ToolGeometry tool;
  tool.name = name;
  tool.friction = friction;
  tool.links.push_back({"", {shape}});
  return tool;
}

inline Pose placedAt(const Vec3& place) { return Pose(Eigen::Translation3d(place)); }

// Of the touches that the solver's last answer is for.
struct TouchSums {
  int pushing = 0;
  double normal = 0.0;          // sum of the normal forces (N)
  double drag = 0.0;            // sum of the lengths of the drags (N)
  double sliding_normal = 0.0;  // likewise, of the touches that slide: at their bound of drag
  double sliding_drag = 0.0;
  double steepest = 0.0;  // greatest drag over normal force of one touch, of those that carry 1 %
  double radius = 0.0;    // of the farthest that pushes from `axis`, at rest, along x and y (m)
};

inline TouchSums touchesOf(const Tissue& tissue, const std::string& tool, const Vec3& axis) {
  TouchSums sums;
  const std::vector<Vec3>& displacement = tissue.state().displacement;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = tissue.namedPatches(); i < tissue.patches().size(); ++i) {
      if (tissue.patches()[i].name != tool) continue;
      for (const ContactSpring& spring : tissue.patches()[i].contacts) {
        const double normal = normalForceOf(spring, displacement);
        if (normal <= 0.0) continue;
        const double drag = (forceOf(spring, displacement) - normal * spring.normal).norm();
        if (pass == 1) {
          if (normal > 0.01 * sums.normal) sums.steepest = std::max(sums.steepest, drag / normal);
          continue;
        }
        ++sums.pushing;
        sums.normal += normal;
        sums.drag += drag;
        if (drag > 0.999 * spring.friction_bound) {
          sums.sliding_normal += normal;
          sums.sliding_drag += drag;
        }
        sums.radius = std::max(sums.radius, (spring.rest - axis).head<2>().norm());
      }
    }
  }
  return sums;
}

}  // namespace robot_tissue
