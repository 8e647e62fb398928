// A probe pressed into a block and withdrawn: what it meets, what it leaves.
#include <gtest/gtest.h>

#include <limits>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_pipeline {
namespace {

TEST_P(PressedBlock, NothingIsSolvedBeforeTheToolTouches) {
  walk(pipeline_, -0.01, -0.001);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_EQ(pipeline_.report().solve_ms, 0.0);
  EXPECT_TRUE(tool().nodes.empty());
  EXPECT_EQ(tool().force_on_tool, Vec3::Zero());
}

TEST_P(PressedBlock, SurfaceStaysOutOfTheTool) {
  for (double depth = 0.0; depth < 0.0075; depth += 0.00025) {
    pipeline_.step(pressed(depth));
    const Vec3 center = pressed(depth).links.front().translation();
    for (const Vec3& vertex : pipeline_.tissue().vertices()) {
      EXPECT_GT((vertex - center).norm(), kRadius - GetParam().hair());
    }
    EXPECT_LT(tool().max_penetration, GetParam().hair());
  }
  EXPECT_GT(greatestDisplacement(pipeline_.tissue()), 0.007);
}

TEST_P(PressedBlock, ForcePushesTheToolOutAndGrowsWithDepth) {
  double last = 0.0;
  walk(pipeline_, -0.001, 0.0);
  for (double depth = 0.001; depth < 0.0065; depth += 0.001) {
    walk(pipeline_, depth - 0.001, depth);
    EXPECT_GT(tool().force_on_tool.z(), last) << "at a depth of " << depth << " m";
    EXPECT_LT(tool().force_on_tool.head<2>().norm(), 0.01 * tool().force_on_tool.z());
    last = tool().force_on_tool.z();
  }
}

TEST_P(PressedBlock, NormalPointsIntoTheTissue) {
  walk(pipeline_, 0.0, 0.004);
  EXPECT_NEAR(tool().normal.z(), -1.0, 1e-3);
  EXPECT_NEAR(tool().point.z(), kTop - 0.003, 0.002);
}

TEST_P(PressedBlock, ComesBackToRestToTheLastBitFourTimes) {
  for (int time = 0; time < 4; ++time) {
    walk(pipeline_, -0.001, 0.006, 0.001);
    ASSERT_GT(greatestDisplacement(pipeline_.tissue()), 0.005);
    walk(pipeline_, 0.006, -0.001, 0.001);
    EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
    EXPECT_TRUE(tool().nodes.empty());
    EXPECT_EQ(tool().force_on_tool, Vec3::Zero());
  }
}

TEST_P(PressedBlock, LeavingInOneGoIsAChange) {
  walk(pipeline_, -0.001, 0.004);
  EXPECT_TRUE(pipeline_.step(pressed(-0.01)).changed);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_FALSE(pipeline_.step(pressed(-0.02)).changed);
}

TEST_P(PressedBlock, StandingStillCostsNothing) {
  walk(pipeline_, 0.0, 0.004);
  const Vec3 force = tool().force_on_tool;
  const StepReport& report = pipeline_.step(pressed(0.004));
  EXPECT_FALSE(report.changed);
  EXPECT_EQ(report.substeps, 0);
  EXPECT_EQ(tool().force_on_tool, force);
}

TEST_P(PressedBlock, SameMotionGivesTheSameBits) {
  Pipeline other = anotherPipeline();
  walk(pipeline_, -0.001, 0.006);
  walk(other, -0.001, 0.006);
  EXPECT_EQ(pipeline_.tissue().state().displacement, other.tissue().state().displacement);
  EXPECT_EQ(tool().force_on_tool, other.report().tools.front().force_on_tool);
}

// One update a second or a hundred: the way is what counts.
TEST_P(PressedBlock, ShapeDoesNotHangOnTheRateOfTheUpdates) {
  SolverConfig solver = methodOf(GetParam().model);
  solver.tolerance = 1e-3;
  Pipeline often(block(GetParam().model), solver, {GetParam().tool()});
  Pipeline rarely(block(GetParam().model), solver, {GetParam().tool()});
  often.step(pressed(0.0));
  walk(often, 0.0, 0.005, 0.00025);
  rarely.step(pressed(0.0));
  rarely.step(pressed(0.005));
  // Flat triangles under a round tool: see FrictionlessPress.
  const bool rigid = GetParam().tool().patch == ToolConfig::Patch::kRigid;
  EXPECT_LT(relativeDifference(rarely.tissue(), often.tissue()), rigid ? 0.01 : 0.06);
}

TEST_P(PressedBlock, JumpIsReportedAndSurvived) {
  walk(pipeline_, 0.0, 0.004);
  EXPECT_TRUE(pipeline_.step(at({Vec3(5.0, 5.0, 5.0)})).too_fast);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_TRUE(pipeline_.step(pressed(0.002)).too_fast);
  EXPECT_GT(tool().force_on_tool.z(), 0.0);
  EXPECT_FALSE(pipeline_.step(pressed(0.0025)).too_fast);
}

// Walked in from outside, it presses as if it had been watched on its way, with rigid patches up to
// the phase of the load steps, else up to that of flat triangles under a round tool.
TEST_P(PressedBlock, ToolThatAppearsInsideIsWalkedIn) {
  EXPECT_EQ(pipeline_.step(pressed(0.005)).were_inside, std::vector<std::size_t>{0});
  const double force = tool().force_on_tool.z();
  EXPECT_LT(tool().max_penetration, GetParam().hair());
  Pipeline watched = anotherPipeline();
  walk(watched, -0.001, 0.005);
  const double share = GetParam().patch == ToolConfig::Patch::kRigid ? 0.3 : 0.06;
  EXPECT_NEAR(force, watched.report().tools.front().force_on_tool.z(), share * force);
}

TEST_P(PressedBlock, ToolThatAppearsBeneathTheSurfaceDoesNotStick) {
  EXPECT_EQ(pipeline_.step(pressed(0.022)).were_inside,
            std::vector<std::size_t>{0});  // all of the sphere is under the top
  EXPECT_GT(greatestDisplacement(pipeline_.tissue()), 0.018);
  walk(pipeline_, 0.022, -0.005, 0.001);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
}

TEST_P(PressedBlock, ReportIsThatOfThePresentShape) {
  walk(pipeline_, -0.001, 0.006);
  ASSERT_LT(pipeline_.tissue().lastReport().volume_ratio, 0.9999);
  pipeline_.step(pressed(-0.01));
  EXPECT_EQ(pipeline_.tissue().lastReport().volume_ratio, 1.0);
  EXPECT_EQ(pipeline_.tissue().lastReport().inverted_cells, 0);
  walk(pipeline_, -0.001, 0.006);
  pipeline_.reset();
  EXPECT_EQ(pipeline_.tissue().lastReport().volume_ratio, 1.0);
}

TEST_P(PressedBlock, OutOfTimeItCatchesUpInLaterSteps) {
  pipeline_.step(pressed(-0.001));
  pipeline_.setBudget(0.0);
  EXPECT_TRUE(pipeline_.step(pressed(0.006)).too_fast);
  int more = 0;
  while (pipeline_.step(pressed(0.006)).too_fast && more < 20) ++more;
  EXPECT_GE(more, 1);
  EXPECT_LT(more, 20);
  for (int late = 0; pipeline_.report().late && late < 2000; ++late) {
    pipeline_.step(pressed(0.006));
  }
  EXPECT_FALSE(pipeline_.report().late);
  EXPECT_NEAR(tool().point.z(), kTop - 0.005, 0.002);
  EXPECT_FALSE(pipeline_.step(pressed(0.006)).changed);
}

TEST_P(PressedBlock, TremorBelowAThousandthOfTheSpacingIsNoMotion) {
  walk(pipeline_, 0.0, 0.004);
  EXPECT_FALSE(pipeline_.step(pressed(0.004 + 4e-6)).changed);
  EXPECT_TRUE(pipeline_.step(pressed(0.004 + 1e-4)).changed);
}

TEST_P(PressedBlock, BadPoseIsRefusedAndNothingChanges) {
  walk(pipeline_, 0.0, 0.004);
  const auto shape = pipeline_.tissue().state().displacement;
  RobotPose broken = pressed(0.004);
  broken.links.front().translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pipeline_.step(broken), InputError);
  EXPECT_THROW(pipeline_.step(at({Vec3::Zero(), Vec3::Zero()})), InputError);
  EXPECT_EQ(pipeline_.tissue().state().displacement, shape);
}

TEST_P(PressedBlock, ResetGivesTheRestShapeAndTheSameAnswerAfterwards) {
  walk(pipeline_, -0.001, 0.005);
  const auto shape = pipeline_.tissue().state().displacement;
  pipeline_.reset();
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  walk(pipeline_, -0.001, 0.005);
  EXPECT_EQ(pipeline_.tissue().state().displacement, shape);
}

TEST_P(PressedBlock, ToolThatGoesAwayLetsGo) {
  walk(pipeline_, -0.001, 0.004);
  RobotPose nowhere;
  nowhere.links = {Pipeline::away()};
  EXPECT_FALSE(pipeline_.step(nowhere).too_fast);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_EQ(tool().force_on_tool, Vec3::Zero());
  EXPECT_EQ(pipeline_.step(pressed(0.004)).were_inside, std::vector<std::size_t>{0});
  EXPECT_GT(tool().force_on_tool.z(), 0.05);
}

TEST_P(PressedBlock, OtherToolsTakeThePlaceOfThePresentOnes) {
  walk(pipeline_, -0.001, 0.004);
  pipeline_.setTools({});
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_TRUE(pipeline_.step({}).tools.empty());
  pipeline_.setTools({GetParam().tool()});
  walk(pipeline_, -0.001, 0.004);
  EXPECT_GT(tool().force_on_tool.z(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Kind, PressedBlock, ::testing::Values(kElastic, kElasticRigid, kSixSpring),
                         [](const auto& row) { return row.param.name; });

class RigidlyPressedBlock : public PressedBlock {};

TEST_P(RigidlyPressedBlock, FindsTheShapesItLeftOnTheWayBack) {
  walk(pipeline_, -0.001, 0.003);
  const Vec3 force_in = tool().force_on_tool;
  walk(pipeline_, 0.003, 0.006);
  ASSERT_GT((tool().force_on_tool - force_in).norm(), 0.1);
  walk(pipeline_, 0.006, 0.003);
  EXPECT_LT((tool().force_on_tool - force_in).norm(), 1e-3 * force_in.norm());
}

INSTANTIATE_TEST_SUITE_P(Kind, RigidlyPressedBlock, ::testing::Values(kElasticRigid, kSixSpring),
                         [](const auto& row) { return row.param.name; });

// Without friction nothing is lost on the way; but flat triangles may lie against a round tool in
// more ways than one, and which of them it is hangs on the way (doc/contact.md).
TEST(FrictionlessPress, MeetsTheSameForceOnTheWayBack) {
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(0.0, probe())});
  const auto force = [&] { return pipeline.report().tools.front().force_on_tool; };
  std::vector<Vec3> on_the_way_in;
  for (double depth = 0.001; depth < 0.0065; depth += 0.001) {
    walk(pipeline, depth - 0.001, depth);
    on_the_way_in.push_back(force());
  }
  for (int back = 4; back >= 0; --back) {
    walk(pipeline, 0.001 * (back + 2), 0.001 * (back + 1));
    const Vec3& before = on_the_way_in[static_cast<std::size_t>(back)];
    EXPECT_LT((force() - before).norm(), 0.2 * before.norm()) << back + 1 << " mm";
  }
}

// A rigid patch would stick to the probe, and the tissue come along.
TEST(ConformingPress, ProbeThatLeavesSidewaysLeavesNothing) {
  Pipeline pipeline(block(), methodOf("elastic"), {probe()});
  const Vec3 above = pressed(-0.001, 0.05).links.front().translation();
  const Vec3 down = pressed(0.003, 0.05).links.front().translation();
  walk(pipeline, {above}, {down}, 0.001);
  ASSERT_GT(pipeline.report().tools.front().force_on_tool.z(), 0.05);
  walk(pipeline, {down}, {down + Vec3(0.025, 0.0, 0.0)}, 0.001);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
  EXPECT_EQ(pipeline.report().tools.front().force_on_tool, Vec3::Zero());
}

// What a solve has no time for is carried on while the tool stands.
TEST(LateBlock, GoesOnUntilItIsInBalance) {
  SolverConfig solver = methodOf("elastic");
  solver.tolerance = 1e-4;
  solver.max_ms = 1e-3;
  Pipeline pipeline(block(), solver, {probe()});
  pipeline.step(pressed(-0.001));
  pipeline.step(pressed(0.003));
  const auto status = [&] { return pipeline.tissue().lastReport().status; };
  ASSERT_EQ(status(), SolveStatus::kLate);
  int more = 0;
  while (status() == SolveStatus::kLate && more < 400) {
    EXPECT_TRUE(pipeline.step(pressed(0.003)).changed);
    ++more;
  }
  EXPECT_EQ(status(), SolveStatus::kOk);
  EXPECT_FALSE(pipeline.step(pressed(0.003)).changed);
}

}  // namespace
}  // namespace robot_tissue::test_pipeline
