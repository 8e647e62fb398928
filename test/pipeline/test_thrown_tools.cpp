// Tools that are thrown through the tissue: what is told once they stand, and that none is
// swallowed without a word.
#include "pipeline_fixtures.h"

namespace robot_tissue::test_thrown_tools {
namespace {

constexpr int kMostUpdates = 400;

bool isSettled(const Pipeline& pipeline) {
  const StepReport& report = pipeline.report();
  return !report.changed && !report.lost && !report.too_fast && !report.late;
}

// Steps until nothing changes any more; the updates that it took.
int standAt(Pipeline& pipeline, const Vec3& place) {
  int updates = 0;
  do {
    pipeline.step(at({place}));
  } while (!isSettled(pipeline) && ++updates < kMostUpdates);
  return updates;
}

// As a tool that stands below the block, or beside it, after one pose in it: with and without a
// bound on load steps.
class ThrownTool : public testing::TestWithParam<int> {
 protected:
  ThrownTool() { pipeline_.setMostIterations(GetParam()); }
  void expectFreeAndAtRest() {
    EXPECT_FALSE(pipeline_.isLate());
    EXPECT_TRUE(pipeline_.hasArrived());
    EXPECT_TRUE(pipeline_.tissue().areContactsSettled());
    EXPECT_EQ(pipeline_.report().tools.front().force_on_tool.norm(), 0.0);
    EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  }

  Pipeline pipeline_{block(), SolverConfig(), {probe()}};
};

TEST_P(ThrownTool, ThatStandsBelowTheTissueFeelsNothing) {
  const Vec3 above(kMiddle, kMiddle, 0.1), below(kMiddle, kMiddle, -0.1);
  EXPECT_LT(standAt(pipeline_, above), kMostUpdates);
  EXPECT_LT(standAt(pipeline_, below), kMostUpdates);
  expectFreeAndAtRest();
}

TEST_P(ThrownTool, ThatStandsBesideTheTissueAfterItStoodDeepInItFeelsNothing) {
  const Vec3 above(kMiddle, kMiddle, 0.1), deep(kMiddle, kMiddle, 0.01),
      beside(kMiddle, 0.25, 0.01);
  EXPECT_LT(standAt(pipeline_, above), kMostUpdates);
  for (int update = 0; update < 20; ++update) pipeline_.step(at({deep}));
  EXPECT_LT(standAt(pipeline_, beside), kMostUpdates);
  expectFreeAndAtRest();
}

INSTANTIATE_TEST_SUITE_P(MostIterations, ThrownTool, testing::Values(0, 36));

// A ball that comes to be all inside meets no surface: that is no shape to show as one in balance.
TEST(SmallBall, IsNotSwallowedWithoutAWord) {
  TissueConfig tissue = block("elastic", 0.01);
  tissue.shape.max() = Vec3(kWidth, kWidth, 0.03);
  tissue.material.poisson_ratio = 0.45;
  ToolShape ball;
  ball.radius = 0.005;
  for (const double tolerance : {0.01, 0.001}) {
    SolverConfig solver;
    solver.tolerance = tolerance;
    for (const double height : {0.02, 0.0175, 0.015, 0.0125}) {
      Pipeline pipeline(tissue, solver, {toolOf(ball)});
      const StepReport& report = pipeline.step(at({Vec3(kMiddle, kMiddle, height)}));
      const bool is_deep = report.tools.front().max_penetration > 0.25 * 0.01;
      const bool is_ok = pipeline.tissue().lastReport().status == SolveStatus::kOk && !report.lost;
      EXPECT_FALSE(is_deep && is_ok) << tolerance << ' ' << height;
      EXPECT_TRUE(report.tools.front().contacts > 0 || report.lost) << tolerance << ' ' << height;
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_thrown_tools
