// Tools beside tissue that moves in time, by every method.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_methods_in_time {
namespace {

constexpr double kCoarse = 0.01;  // m
constexpr double kPause = 0.005;  // s, between poses
constexpr double kDensity = 1000.0;

TissueConfig soft() {
  TissueConfig tissue = block("elastic", kCoarse);
  tissue.time = TimeConfig{0.01};
  tissue.material.density = kDensity;
  return tissue;
}

struct Case {
  const char* method;
  double off;  // how far its forces may be from those of `layered`, of the greatest
  double trembles;
};

std::string nameOf(const testing::TestParamInfo<Case>& info) { return info.param.method; }

class MethodInTime : public testing::TestWithParam<Case> {
 protected:
  static SolverConfig solver(const std::string& method) {
    SolverConfig solver;
    solver.method = method;
    return solver;
  }
  static Pipeline pipelineOf(const TissueConfig& tissue, const std::string& method,
                             double friction) {
    return {tissue, solver(method), {withFriction(friction, probe())}};
  }
  static Vec3 step(Pipeline& pipeline, RobotPose pose, double& stamp, double pause = kPause) {
    pose.stamp_s = stamp += pause;
    pipeline.step(pose);
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << stamp;
    return pipeline.report().tools.front().force_on_tool;
  }
  // Pressed 4 mm at 20 mm/s, then dragged by 10 mm, then held.
  static std::vector<Vec3> dragged(const std::string& method) {
    Pipeline pipeline = pipelineOf(soft(), method, 0.3);
    std::vector<Vec3> forces;
    double stamp = 0.0;
    for (int i = 0; i <= 50; ++i) {
      forces.push_back(step(pipeline, pressed(-0.001 + 1e-4 * i), stamp));
    }
    for (int i = 0; i < 100; ++i) {
      forces.push_back(step(pipeline, pressed(0.004, kMiddle - 0.005 + 1e-4 * i), stamp));
    }
    for (int i = 0; i < 60; ++i) {
      forces.push_back(step(pipeline, pressed(0.004, kMiddle + 0.005), stamp));
    }
    return forces;
  }
};

TEST_P(MethodInTime, ADraggedToolFeelsWhatItFeelsByLayered) {
  const std::vector<Vec3> right = dragged("layered"), forces = dragged(GetParam().method);
  double greatest = 0.0, squared = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    squared += (forces[i] - right[i]).squaredNorm();
    greatest = std::max(greatest, right[i].norm());
  }
  EXPECT_LT(std::sqrt(squared / static_cast<double>(forces.size())), GetParam().off * greatest);
}

// What is held does not bounce off the tool: the force is the same from pose to pose.
TEST_P(MethodInTime, AToolThatStandsFeelsTheSameForce) {
  const std::vector<Vec3> forces = dragged(GetParam().method);
  for (std::size_t i = forces.size() - 10; i < forces.size(); ++i) {
    EXPECT_LT((forces[i] - forces.back()).norm(), GetParam().trembles * forces.back().norm()) << i;
  }
}

// A block that nothing holds is pushed: what its tool gives it in force times time is its momentum.
TEST_P(MethodInTime, ImpulseIsMomentum) {
  TissueConfig tissue = soft();
  tissue.fixed.clear();
  Pipeline pipeline = pipelineOf(tissue, GetParam().method, 0.0);
  const auto center = [&] {
    Vec3 sum = Vec3::Zero();
    double mass = 0.0;
    const Lattice& lattice = pipeline.tissue().lattice();
    for (const Cell& cell : lattice.cells()) {
      for (const int node : cell.nodes) {
        sum += pipeline.tissue().nodePosition(node) * cell.share();
        mass += cell.share();
      }
    }
    return Vec3(sum / mass);
  };
  constexpr double kShort = 0.001;  // s: an update is a load step
  const double mass = kDensity * kWidth * kWidth * kTop;
  double stamp = 0.0;
  Vec3 impulse = Vec3::Zero(), before = center();
  for (int i = 0; i <= 80; ++i) {
    before = center();
    impulse -= kShort * step(pipeline, pressed(-0.001 + 5e-5 * i), stamp, kShort);
    ASSERT_LE(pipeline.report().substeps, 1) << i;
  }
  const Vec3 momentum = mass / kShort * (center() - before);
  EXPECT_LT(momentum.z(), -1e-4);
  EXPECT_NEAR(momentum.z(), impulse.z(), 0.02 * std::abs(momentum.z()));
}

INSTANTIATE_TEST_SUITE_P(All, MethodInTime,
                         testing::Values(Case{"layered", 1e-12, 0.01}, Case{"newton", 0.02, 0.01},
                                         Case{"vbd", 0.05, 0.01}, Case{"explicit", 0.05, 0.01},
                                         Case{"xpbd", 0.2, 0.05}),
                         nameOf);

}  // namespace
}  // namespace robot_tissue::test_methods_in_time
