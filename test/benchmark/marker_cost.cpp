// What drawing for rviz costs an update that is drawn: a block under a sphere pressed 5 mm deep,
// with a cut and two sutures, by what the surface's color tells. Not a test: nothing here passes or
// fails. Prints CSV; times are the wall's, of 50 frames; reach_us is what every update pays for the
// drawn forces, without a listener, too. doc/node_speed.md has them.
//
//   marker_cost
#include <ros/serialization.h>

#include <cstdio>
#include <vector>

#include "contact_trial.h"
#include "robot_tissue/ros/markers.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kWidth = 0.1, kHeight = 0.05, kRadius = 0.01;  // m
constexpr int kFrames = 50, kReaches = 10000;

void press(Pipeline& pipeline) {
  pipeline.cut({{0.031, -1, 0.03}, {0.031, 1, 0.03}, {0.031, 1, 1}, {0.031, -1, 1}});
  for (const double y : {0.03, 0.07}) {
    SutureConfig suture;
    suture.name = y < 0.05 ? "near" : "far";
    suture.from = Vec3(0.02, y, kHeight);
    suture.to = Vec3(0.04, y, kHeight);
    suture.rest_length = 0.02;
    pipeline.suture(suture);
  }
  for (double depth = -0.001; depth <= 0.005; depth += 0.0005) {
    RobotPose pose;
    pose.links.push_back(Pose::Identity());
    pose.links.front().translation() = Vec3(0.06, 0.05, kHeight + kRadius - depth);
    pipeline.step(pose);
  }
}

// Mean, of one.
double reachMicroseconds(const Pipeline& pipeline, MarkerBuilder& builder) {
  const auto start = Clock::now();
  for (int i = 0; i < kReaches; ++i) builder.reach(pipeline, ros::Time(1.0 + 1e-3 * i));
  return 1e3 * millisecondsSince(start) / kReaches;
}

void tell(const Pipeline& pipeline, ColorBy color) {
  MarkerBuilder builder("tissue", {0.02, color}, {});
  const double reach_us = reachMicroseconds(pipeline, builder);
  std::vector<double> times;
  std::size_t bytes = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto start = Clock::now();
    const auto array = builder.build(pipeline, ros::Time(1.0));
    times.push_back(millisecondsSince(start));
    bytes = ros::serialization::serializationLength(array);
  }
  std::printf("%d,%s,%.3g,%.3g,%.0f,%.3g\n", pipeline.tissue().lattice().nodeCount(),
              meaningOf(color).name, quantile(times, 0.5), quantile(times, 0.99),
              1e-3 * static_cast<double>(bytes), reach_us);
}

}  // namespace
}  // namespace robot_tissue

int main() {
  using namespace robot_tissue;
  std::printf("nodes,color,median_ms,p99_ms,kB,reach_us\n");
  for (const int cells_high : {10, 20}) {
    Pipeline pipeline(blockOf(Vec3(kWidth, kWidth, kHeight), kHeight / cells_high), SolverConfig(),
                      {toolOf("sphere", sphereOf(kRadius), 0.3)});
    press(pipeline);
    for (const ColorBy color :
         {ColorBy::kNone, ColorBy::kDisplacement, ColorBy::kStrain, ColorBy::kPressure}) {
      tell(pipeline, color);
    }
  }
}
