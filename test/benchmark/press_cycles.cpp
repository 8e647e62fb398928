// Presses a tool into the top of a fixed block and withdraws it, again and again, in increments of
// the motion at 100 Hz. Prints the greatest depth of the tool inside the displayed surface, found
// by sampling every triangle densely against the tool's own formula, not by the contact search;
// what is left of the displacement; and the times. usage: press_cycles [CYCLES] [DEPTH_MM]
// [SPEED_MM_PER_S] [MODEL]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "robot_tissue/core/method_names.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {
namespace {

constexpr double kTop = 0.05;             // of the block (m)
constexpr double kClearance = 0.001;      // above the top, where a cycle starts (m)
constexpr double kUpdatePeriod = 0.01;    // s
constexpr int kSamples = 25;              // along a triangle's edge
const Vec3 kUnder(0.0507, 0.0493, kTop);  // off the nodes

// A tool whose origin is its lowest point, and how deep a point is inside it (m).
struct Probe {
  std::string name;
  ToolShape shape;
  std::function<double(const Vec3&)> depth;
};

Probe sphere(double radius) {
  Probe probe;
  probe.name = "sphere";
  probe.shape.radius = radius;
  probe.shape.pose.translation().z() = radius;
  probe.depth = [radius](const Vec3& point) {
    return radius - (point - Vec3(0, 0, radius)).norm();
  };
  return probe;
}

Probe box(double width, double height) {
  Probe probe;
  probe.name = "box";
  probe.shape.type = ToolShape::Type::kBox;
  probe.shape.size = Vec3(width, width, height);
  probe.shape.pose.translation().z() = height / 2;
  probe.depth = [width, height](const Vec3& point) {
    return std::min({width / 2 - std::abs(point.x()), width / 2 - std::abs(point.y()), point.z(),
                     height - point.z()});
  };
  return probe;
}

Probe cylinder(const std::string& name, double radius, double length) {
  Probe probe;
  probe.name = name;
  probe.shape.type = ToolShape::Type::kCylinder;
  probe.shape.radius = radius;
  probe.shape.length = length;
  probe.shape.pose.translation().z() = length / 2;
  probe.depth = [radius, length](const Vec3& point) {
    return std::min({radius - point.head<2>().norm(), point.z(), length - point.z()});
  };
  return probe;
}

double deepestSample(const Tissue& tissue, const Probe& probe, const Vec3& tip) {
  double deepest = 0.0;
  for (const auto& triangle : tissue.surface().triangles) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = tissue.vertices()[static_cast<std::size_t>(triangle[i])] - tip;
    }
    if ((corners[0].head<2>()).norm() > 0.04) continue;  // out of reach of every probe
    for (int i = 0; i <= kSamples; ++i) {
      for (int j = 0; i + j <= kSamples; ++j) {
        const double a = static_cast<double>(i) / kSamples, b = static_cast<double>(j) / kSamples;
        deepest = std::max(deepest,
                           probe.depth(a * corners[0] + b * corners[1] + (1 - a - b) * corners[2]));
      }
    }
  }
  return deepest;
}

double greatestDisplacement(const Tissue& tissue) {
  double greatest = 0.0;
  for (const Vec3& moved : tissue.state().displacement) greatest = std::max(greatest, moved.norm());
  return greatest;
}

void run(const Probe& probe, int cycles, double depth, double speed, const std::string& model) {
  TissueConfig tissue;
  tissue.model = model;
  tissue.shape.max() = Vec3(0.1, 0.1, kTop);
  tissue.spacing = 0.005;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back({Vec3(-1, -1, -1e-6), Vec3(1, 1, 1e-6)});
  SolverConfig solver;
  solver.method = methodsFor(model).front();
  ToolGeometry tool;
  tool.name = probe.name;
  tool.links.push_back({probe.name, {probe.shape}});
  if (model != "elastic") tool.patch = ToolConfig::Patch::kRigid;  // all that it can do
  Pipeline pipeline(tissue, solver, {tool});
  const double way = depth + kClearance;
  const int updates = static_cast<int>(std::ceil(way / (speed * kUpdatePeriod)));
  double deepest = 0.0, left = 0.0, greatest_force = 0.0;
  std::vector<double> times_ms;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    for (int i = 0; i <= 2 * updates; ++i) {
      const double gone = way * (i <= updates ? i : 2 * updates - i) / updates;
      RobotPose pose;
      pose.links.push_back(Pose::Identity());
      pose.links[0].translation() = kUnder + Vec3(0, 0, kClearance - gone);
      const StepReport& report = pipeline.step(pose);
      times_ms.push_back(report.contact_ms + report.solve_ms);
      greatest_force = std::max(greatest_force, report.tools[0].force_on_tool.norm());
      deepest =
          std::max(deepest, deepestSample(pipeline.tissue(), probe, pose.links[0].translation()));
    }
    left = std::max(left, greatestDisplacement(pipeline.tissue()));
  }
  std::sort(times_ms.begin(), times_ms.end());
  std::printf("%s,%d,%.1f,%.4f,%.3g,%.3f,%.2f,%.2f\n", probe.name.c_str(), cycles, 1e3 * depth,
              1e3 * deepest, 1e3 * left, greatest_force, times_ms[times_ms.size() / 2],
              times_ms[times_ms.size() * 99 / 100]);
  std::fflush(stdout);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  const int cycles = argc > 1 ? std::atoi(argv[1]) : 20;
  const double depth = 1e-3 * (argc > 2 ? std::atof(argv[2]) : 10.0);
  const double speed = 1e-3 * (argc > 3 ? std::atof(argv[3]) : 20.0);
  const std::string model = argc > 4 ? argv[4] : "elastic";
  std::printf(
      "tool,cycles,depth_mm,deepest_in_surface_mm,left_mm,greatest_force_n,median_ms,p99_ms\n");
  for (const auto& probe : {robot_tissue::sphere(0.01), robot_tissue::box(0.02, 0.04),
                            robot_tissue::cylinder("cylinder", 0.004, 0.04),
                            robot_tissue::cylinder("needle", 0.0005, 0.04)}) {
    robot_tissue::run(probe, cycles, depth, speed, model);
  }
  return 0;
}
