#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline_fixtures.h"

namespace robot_tissue {
namespace {

// With each model and its method.
class PressedBlock : public ::testing::TestWithParam<const char*> {
 protected:
  Pipeline pipeline_{block(GetParam()), methodOf(GetParam()), {probe()}};

  Pipeline anotherPipeline() const { return {block(GetParam()), methodOf(GetParam()), {probe()}}; }
  const ToolReport& tool() const { return pipeline_.report().tools.front(); }
};

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
    const Vec3 center = pressed(depth).tools.front().translation();
    for (const Vec3& vertex : pipeline_.tissue().vertices()) {
      EXPECT_GT((vertex - center).norm(), kRadius - 0.01 * kSpacing);
    }
    EXPECT_LT(tool().max_penetration, 0.01 * kSpacing);
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

TEST_P(PressedBlock, ComesBackToRestToTheLastBitTwentyTimes) {
  for (int time = 0; time < 20; ++time) {
    walk(pipeline_, -0.001, 0.006, 0.0007);
    ASSERT_GT(greatestDisplacement(pipeline_.tissue()), 0.005);
    walk(pipeline_, 0.006, -0.001, 0.0007);
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

TEST_P(PressedBlock, FindsTheShapesItLeftOnTheWayBack) {
  walk(pipeline_, -0.001, 0.003);
  const Vec3 force_in = tool().force_on_tool;
  walk(pipeline_, 0.003, 0.006);
  ASSERT_GT((tool().force_on_tool - force_in).norm(), 0.1);
  walk(pipeline_, 0.006, 0.003);
  EXPECT_LT((tool().force_on_tool - force_in).norm(), 1e-3 * force_in.norm());
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
}

// One update a second or a hundred: the way is what counts.
TEST_P(PressedBlock, ShapeDoesNotHangOnTheRateOfTheUpdates) {
  Pipeline rarely = anotherPipeline();
  pipeline_.step(pressed(0.0));
  walk(pipeline_, 0.0, 0.005, 0.0001);
  rarely.step(pressed(0.0));
  rarely.step(pressed(0.005));
  double difference = 0.0, size = 0.0;
  for (std::size_t node = 0; node < rarely.tissue().state().displacement.size(); ++node) {
    const Vec3& often = pipeline_.tissue().state().displacement[node];
    difference += (often - rarely.tissue().state().displacement[node]).squaredNorm();
    size += often.squaredNorm();
  }
  EXPECT_LT(std::sqrt(difference / size), 0.01);
}

TEST_P(PressedBlock, FastToolDoesNotPassThrough) {
  pipeline_.step(pressed(-0.02));
  const StepReport& report = pipeline_.step(pressed(0.006));  // 26 mm in one update
  EXPECT_FALSE(report.too_fast);
  EXPECT_GT(report.substeps, 0.025 / pipeline_.tissue().stepLength());
  EXPECT_LT(tool().max_penetration, 0.01 * kSpacing);
  EXPECT_GT(tool().force_on_tool.z(), 0.1);
}

TEST_P(PressedBlock, JumpIsReportedAndSurvived) {
  walk(pipeline_, 0.0, 0.004);
  EXPECT_TRUE(pipeline_.step(at({Vec3(5.0, 5.0, 5.0)})).too_fast);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_TRUE(pipeline_.step(pressed(0.002)).too_fast);
  EXPECT_GT(tool().force_on_tool.z(), 0.0);
  EXPECT_FALSE(pipeline_.step(pressed(0.0025)).too_fast);
}

// Walked in from outside, it presses as if it had been watched on its way, up to the phase of the
// load steps.
TEST_P(PressedBlock, ToolThatAppearsInsideIsWalkedIn) {
  pipeline_.step(pressed(0.005));
  const double force = tool().force_on_tool.z();
  EXPECT_LT(tool().max_penetration, 0.01 * kSpacing);
  Pipeline watched = anotherPipeline();
  walk(watched, -0.001, 0.005);
  EXPECT_NEAR(force, watched.report().tools.front().force_on_tool.z(), 0.3 * force);
}

TEST_P(PressedBlock, ToolThatAppearsBeneathTheSurfaceDoesNotStick) {
  pipeline_.step(pressed(0.028));  // the whole sphere is under the top
  EXPECT_GT(greatestDisplacement(pipeline_.tissue()), 0.02);
  walk(pipeline_, 0.028, -0.005, 0.001);
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
  EXPECT_NEAR(tool().point.z(), kTop - 0.005, 0.002);
  EXPECT_FALSE(pipeline_.step(pressed(0.006)).changed);
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
  while (status() == SolveStatus::kLate && more < 100) {
    EXPECT_TRUE(pipeline.step(pressed(0.003)).changed);
    ++more;
  }
  EXPECT_EQ(status(), SolveStatus::kOk);
  EXPECT_FALSE(pipeline.step(pressed(0.003)).changed);
}

TEST_P(PressedBlock, TremorBelowAThousandthOfTheSpacingIsNoMotion) {
  walk(pipeline_, 0.0, 0.004);
  EXPECT_FALSE(pipeline_.step(pressed(0.004 + 4e-6)).changed);
  EXPECT_TRUE(pipeline_.step(pressed(0.004 + 1e-4)).changed);
}

TEST_P(PressedBlock, PoseThatIsNotFiniteIsRefusedAndNothingChanges) {
  walk(pipeline_, 0.0, 0.004);
  const auto shape = pipeline_.tissue().state().displacement;
  RobotPose broken = pressed(0.004);
  broken.tools.front().translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pipeline_.step(broken), InputError);
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

TEST_P(PressedBlock, CutUnderLoadStaysAndTheToolStaysOut) {
  walk(pipeline_, -0.001, 0.004);
  const CutReport cut =
      pipeline_.tissue().cut({Vec3(0.0475, -0.01, 0.02), Vec3(0.0475, 0.06, 0.02),
                              Vec3(0.0475, 0.06, 0.07), Vec3(0.0475, -0.01, 0.07)});
  pipeline_.touch();
  EXPECT_GT(cut.springs_cut, 0);
  walk(pipeline_, 0.004, 0.005);
  EXPECT_LT(tool().max_penetration, 0.05 * kSpacing);
  walk(pipeline_, 0.005, -0.001);
  EXPECT_EQ(pipeline_.tissue().state().springs_cut, cut.springs_cut);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Model, PressedBlock, ::testing::Values("elastic", "six_spring"),
                         [](const auto& model) { return std::string(model.param); });

// The probe presses on both edges of the cut, nodes and ghosts.
TEST(PressedElasticBlock, CutOpensUnderTheToolAndClosesAgain) {
  TissueConfig tissue = block();
  tissue.model = "elastic";
  tissue.spacing = 0.0125;
  SolverConfig solver;
  solver.method = "newton";
  Pipeline pipeline(tissue, solver, {probe()});
  walk(pipeline, -0.001, 0.002, 0.001);
  const double whole = pipeline.report().tools.front().force_on_tool.z();
  pipeline.tissue().cut({Vec3(0.0563, -0.01, 0.02), Vec3(0.0563, 0.11, 0.02),
                         Vec3(0.0563, 0.11, 0.07), Vec3(0.0563, -0.01, 0.07)});
  pipeline.touch();
  walk(pipeline, 0.002, 0.006, 0.001);
  const ToolReport& tool = pipeline.report().tools.front();
  EXPECT_LT(tool.max_penetration, 0.05 * tissue.spacing);
  EXPECT_GT(tool.force_on_tool.z(), whole);
  const CellSet& cells = *pipeline.tissue().state().cells;
  EXPECT_TRUE(std::any_of(tool.nodes.begin(), tool.nodes.end(),
                          [&](int node) { return cells.isGhost(node); }));
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
  walk(pipeline, 0.006, -0.001, 0.001);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST_P(PressedBlock, NamedLoadStandsBesideTheTool) {
  pipeline_.step(pressed(-0.001));
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, 0.01, kTop)};
  patch.displacement = {{0.0, 0.0, -0.002}};
  pipeline_.tissue().load({1, {patch}});
  pipeline_.touch();
  walk(pipeline_, -0.001, 0.004);
  EXPECT_GT(tool().force_on_tool.z(), 0.1);
  walk(pipeline_, 0.004, -0.001);
  EXPECT_EQ(tool().force_on_tool, Vec3::Zero());
  const int corner = pipeline_.tissue().lattice().node(0, 0, 10);
  EXPECT_EQ(pipeline_.tissue().state().displacement[static_cast<std::size_t>(corner)],
            Vec3(0.0, 0.0, -0.002));
}

// The same press by a tool whose frame is turned and set off: its wrench is the same, told in its
// own frame and about its own origin.
TEST(Wrench, IsInTheToolsFrameAboutItsOrigin) {
  const Vec3 offset(0.02, 0.0, 0.03);  // of the sphere in the tool's frame
  Pipeline plain(block(), {}, {probe()});
  Pipeline turned(block(), {}, {probe("probe", offset)});
  Pose rotation = Pose::Identity();
  rotation.linear() = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
  for (double depth = -0.0005; depth < 0.004; depth += 0.0005) {
    const RobotPose pose = pressed(depth);
    plain.step(pose);
    RobotPose same = pose;
    same.tools.front().linear() = rotation.linear();
    same.tools.front().translation() -= rotation.linear() * offset;
    turned.step(same);
  }
  const Vec3 force = plain.report().tools.front().force_on_tool;
  const ToolReport& told = turned.report().tools.front();
  ASSERT_GT(force.norm(), 0.1);
  EXPECT_NEAR((rotation.linear() * told.force_on_tool - force).norm(), 0.0, 1e-6);
  const Vec3 torque = offset.cross(told.force_on_tool);
  ASSERT_GT(torque.norm(), 1e-3);
  EXPECT_NEAR((told.torque_on_tool - torque).norm(), 0.0, 0.02 * torque.norm());
}

TEST(TwoTools, OneLeavesTheOtherStays) {
  Pipeline pipeline(block(), {}, {probe("left"), probe("right")});
  const auto both = [](double left, double right) {
    return at(
        {Vec3(0.025, 0.05, kTop + kRadius - left), Vec3(0.075, 0.05, kTop + kRadius - right)});
  };
  for (double depth = 0.0; depth < 0.004; depth += 0.0005) pipeline.step(both(depth, depth));
  const StepReport& report = pipeline.report();
  ASSERT_GT(report.tools[0].force_on_tool.z(), 0.1);
  EXPECT_NEAR(report.tools[0].force_on_tool.z(), report.tools[1].force_on_tool.z(), 1e-4);
  for (double lift = 0.0; lift < 0.006; lift += 0.0005) pipeline.step(both(0.0035, 0.0035 - lift));
  EXPECT_EQ(report.tools[1].force_on_tool, Vec3::Zero());
  EXPECT_GT(report.tools[0].force_on_tool.z(), 0.1);
  for (double lift = 0.0; lift < 0.006; lift += 0.0005) pipeline.step(both(0.0035 - lift, -0.002));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

}  // namespace
}  // namespace robot_tissue
