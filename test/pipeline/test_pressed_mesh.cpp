// A probe against tissue whose shape is a mesh: a ball, of which no node is on the surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../core/mesh_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_pressed_mesh {
namespace {

constexpr double kBall = 0.033;     // radius (m)
constexpr double kBallCell = 0.01;  // spacing (m)

class PressedBall : public ::testing::Test {
 protected:
  Pipeline pipeline_{ball(), {}, {probe()}};

  static TissueConfig ball() {
    TissueConfig tissue;
    tissue.mesh = std::make_shared<const TriangleMesh>(sphereMesh(kBall, 4));
    tissue.spacing = kBallCell;
    tissue.material.young_modulus = 1e4;
    tissue.fixed.push_back({Vec3(-1, -1, -1), Vec3(1, 1, -0.02)});
    return tissue;
  }
  // Along a way that slants into the ball, off its middle.
  static RobotPose slanting(double depth) {
    const Vec3 way = Vec3(0.3, -0.2, 1.0).normalized();
    return at({(kBall + kRadius - depth) * way});
  }
  void go(double from, double to) {
    const int count = static_cast<int>(std::ceil(std::abs(to - from) / 0.0005 - 1e-9));
    for (int i = 1; i <= count; ++i) pipeline_.step(slanting(from + (to - from) * i / count));
  }
  const ToolReport& tool() const { return pipeline_.report().tools.front(); }
};

TEST_F(PressedBall, SurfaceStaysOutOfTheToolAndComesBackToTheLastBit) {
  for (int time = 0; time < 3; ++time) {
    pipeline_.step(slanting(-0.001));
    EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
    for (double depth = 0.0; depth < 0.006; depth += 0.0005) {
      pipeline_.step(slanting(depth));
      const Vec3 center = slanting(depth).links.front().translation();
      for (const Vec3& vertex : pipeline_.tissue().vertices()) {
        EXPECT_GT((vertex - center).norm(), kRadius - 0.05 * kBallCell);
      }
      EXPECT_LT(tool().max_penetration, 0.05 * kBallCell);
    }
    EXPECT_GT(tool().force_on_tool.normalized().dot(Vec3(0.3, -0.2, 1.0).normalized()), 0.8);
    EXPECT_GT(greatestDisplacement(pipeline_.tissue()), 0.003);
    go(0.006, -0.001);
    EXPECT_TRUE(tool().nodes.empty());
    EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  }
}

// Small balls touch less than a spacing's width: Hertz (1882) of two balls. Where the surface was,
// between the nodes, they felt up to 2.2 times that. The ball of tissue is of triangles, up to 0.01
// mm inside its sphere.
TEST(SmallBallOnABall, FeelsAsHertzWhereverItTouches) {
  constexpr double kTissue = 0.04, kProbe = 0.005, kModulus = 1e4, kPoisson = 0.45;
  TissueConfig tissue;
  tissue.mesh = std::make_shared<const TriangleMesh>(sphereMesh(kTissue, 5));
  tissue.spacing = 0.005;
  tissue.material.young_modulus = kModulus;
  tissue.material.poisson_ratio = kPoisson;
  tissue.fixed.push_back({Vec3(-1, -1, -1), Vec3(1, 1, -0.02)});
  ToolShape ball;
  ball.radius = kProbe;
  const double of_both = 1.0 / (1.0 / kProbe + 1.0 / kTissue);
  const auto hertz = [&](double depth) {
    return 4.0 / 3.0 * kModulus / (1.0 - kPoisson * kPoisson) * std::sqrt(of_both) *
           std::pow(depth, 1.5);
  };
  for (const Vec3& way : {Vec3(0, 0, 1), Vec3(0.3, 0.3, 1), Vec3(0.6, 0.2, 1), Vec3(1, 0, 1),
                          Vec3(1, 0.5, 0.1), Vec3(1, 1, 1)}) {
    const Vec3 out = way.normalized();
    Pipeline pipeline(tissue, {}, {toolOf(ball)});
    for (const double depth : {-0.0001, 0.0005, 0.001, 0.002}) {
      pipeline.step(at({(kTissue + kProbe - depth) * out}));
      const double force = pipeline.report().tools.front().force_on_tool.dot(out);
      if (depth >= 0.0005) {
        EXPECT_NEAR(force / hertz(depth), 1.0, 0.2) << depth << " m, " << way.transpose();
      }
    }
  }
}

// The ball does not reach into the corners of the grid around it.
TEST_F(PressedBall, ToolInAnEmptyCornerOfTheGridIsOutside) {
  const Vec3 corner = 0.999 * (kBall + kRadius) / std::sqrt(3.0) * Vec3::Ones();
  ASSERT_LT(corner.x(), 0.04);
  pipeline_.step(at({1.01 * corner}));
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  pipeline_.step(at({0.96 * corner}));
  EXPECT_GT(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_LT(tool().normal.dot(corner.normalized()), -0.9);
}

// Of the last solves of all updates; and the force at the end (N).
std::pair<int, double> iterationsAndForce(int subdivisions) {
  TissueConfig tissue;
  tissue.mesh = std::make_shared<const TriangleMesh>(sphereMesh(kBall, subdivisions));
  tissue.spacing = kBallCell;
  tissue.material.young_modulus = 1e4;
  tissue.material.poisson_ratio = 0.45;
  tissue.fixed.push_back({Vec3(-1, -1, -1), Vec3(1, 1, -0.02)});
  Pipeline pipeline(tissue, {}, {probe()});
  int iterations = 0;
  for (int update = -1; update <= 20; ++update) {
    pipeline.step(at({Vec3(0.0, 0.0, kBall + kRadius - 0.00025 * update)}));
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << update;
    iterations += pipeline.tissue().lastReport().iterations;
  }
  return {iterations, pipeline.report().tools.front().force_on_tool.z()};
}

// Hundreds of vertices touch on a few tens of nodes.
TEST(FineMesh, CostsAToolNoMoreThanACoarserOne) {
  const auto [on_coarse, coarse] = iterationsAndForce(3);
  const auto [on_fine, fine] = iterationsAndForce(5);
  EXPECT_LT(on_fine, 1.5 * on_coarse);
  EXPECT_NEAR(fine, coarse, 0.07 * coarse);  // the coarser ball is smaller
}

TEST_F(PressedBall, CutUnderLoadStaysClosedAndTheToolStaysOut) {
  go(-0.001, 0.003);
  const double volume = pipeline_.tissue().lastReport().volume_ratio;
  const CutReport cut = pipeline_.cut(
      {Vec3(0.001, -1, 0.0), Vec3(0.001, 1, 0.0), Vec3(0.001, 1, 1), Vec3(0.001, -1, 1)});
  EXPECT_GT(cut.springs_cut, 0);
  EXPECT_NEAR(cut.solve.volume_ratio, volume, 0.05);
  go(0.003, 0.005);
  EXPECT_LT(tool().max_penetration, 0.05 * kBallCell);
  go(0.005, -0.001);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
}

// The force of a ball of two spacings, pressed by four tenths of one into a block whose face stands
// `off` spacings over a plane of nodes; what is far off shifts the grid.
double pressedBlock(double off, double spacing) {
  const Vec3 half(0.05, 0.05, 0.0);
  const Vec3 far(0.2, 0.0, 0.0), size = Vec3::Constant(spacing) + off * spacing * Vec3(0.3, 0.7, 1);
  TissueConfig tissue;
  tissue.mesh = std::make_shared<const TriangleMesh>(
      joined(boxMesh(Vec3(0, 0, -0.1) - half, half), boxMesh(far, far + size)));
  tissue.spacing = spacing;
  tissue.material.young_modulus = 1e4;
  tissue.material.poisson_ratio = 0.45;
  tissue.fixed.push_back({Vec3(-1, -1, -1), Vec3(1, 1, -0.05)});
  tissue.fixed.push_back({Vec3(0.1, -1, -1), Vec3(1, 1, 1)});
  SolverConfig solver;
  solver.tolerance = 1e-3;
  Pipeline pipeline(tissue, solver, {probe()});
  walk(pipeline, {Vec3(0, 0, kRadius + 0.0001)}, {Vec3(0, 0, kRadius - 0.002)});
  return pipeline.report().tools.front().force_on_tool.z();
}

// A dent of less than two spacings: with points that are carried trilinearly a quarter too much.
TEST(PressedMesh, BlockFeelsTheSameWhereverItsFaceStands) {
  const double fine = pressedBlock(0.3, 0.0025);
  double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
  for (const double off : {-0.5, -0.25, 0.0, 0.25, 0.5, 1.0}) {
    const double force = pressedBlock(off, 0.005);
    EXPECT_NEAR(force, fine, 0.12 * fine) << off;
    least = std::min(least, force);
    greatest = std::max(greatest, force);
  }
  EXPECT_LT(greatest, 1.15 * least);
}

}  // namespace
}  // namespace robot_tissue::test_pressed_mesh
