// Tools at which nothing is to be done: that stand, or pass by far off.
#include <optional>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_still_tools {
namespace {

RobotPose shiftedBy(double way) {
  return at({Vec3(kMiddle + way, kMiddle, kTop + kRadius - 0.003)});
}

// Steps at the pose until one does nothing.
void settle(Pipeline& pipeline, const RobotPose& pose) {
  int steps = 0;
  while (pipeline.step(pose).changed && ++steps < 100) {
  }
  ASSERT_LT(steps, 100);
}

TEST_P(PressedBlock, SaysAtWhichPosesAStepDoesNothing) {
  EXPECT_FALSE(pipeline_.stillPose().has_value()) << "there was no step yet";
  walk(pipeline_, -0.001, 0.003);
  settle(pipeline_, shiftedBy(0.0));
  const std::optional<StillPose> still = pipeline_.stillPose();
  ASSERT_TRUE(still.has_value());
  for (const double way : {0.0, 0.5e-3 * kSpacing, 2e-3 * kSpacing}) {
    EXPECT_EQ(still->holds(shiftedBy(way)), way < 1e-3 * kSpacing) << way << " m";
    EXPECT_EQ(still->holds(shiftedBy(way)), !pipeline_.step(shiftedBy(way)).changed) << way << " m";
  }
}

TEST_P(PressedBlock, TurnedToolOrBadPoseIsNotStill) {
  settle(pipeline_, shiftedBy(0.0));
  const std::optional<StillPose> still = pipeline_.stillPose();
  ASSERT_TRUE(still.has_value());
  RobotPose turned = shiftedBy(0.0), bad = shiftedBy(0.0);
  turned.links.front().linear() = Eigen::AngleAxisd(0.1, Vec3::UnitX()).toRotationMatrix();
  bad.links.front().translation().y() = std::nan("");
  EXPECT_FALSE(still->holds(turned));
  EXPECT_FALSE(still->holds(bad));
  EXPECT_FALSE(still->holds(at({Vec3::Zero(), Vec3::Zero()}))) << "two links";
}

TEST_P(PressedBlock, NothingIsStillAfterWhatTheNextStepHasToSee) {
  settle(pipeline_, shiftedBy(0.0));
  pipeline_.cut({{0.02, -1, 0.03}, {0.02, 1, 0.03}, {0.02, 1, 0.05}, {0.02, -1, 0.05}});
  EXPECT_FALSE(pipeline_.stillPose().has_value()) << "a cut";
  settle(pipeline_, shiftedBy(0.0));
  EXPECT_TRUE(pipeline_.stillPose().has_value());
  pipeline_.push(0, Vec3(0.0, 0.0, -0.1));
  EXPECT_FALSE(pipeline_.stillPose().has_value()) << "a tool that a force drives";
  pipeline_.reset();
  EXPECT_FALSE(pipeline_.stillPose().has_value()) << "a reset";
}

// Far off there is no load step; what it meets later is what a tool meets that came straight.
TEST(PassingTool, TakesNoLoadStepAndLeavesNothing) {
  Pipeline passes(block(), methodOf("elastic"), {probe()});
  const Vec3 above = pressed(-0.001).links.front().translation();
  const Vec3 far = above + Vec3(0.3, 0.1, 0.05);
  passes.step(at({far}));
  for (int step = 1; step <= 10; ++step) {
    const Vec3 place = far + Vec3(0.0, 0.0, 0.01 * step);
    const StepReport& report = passes.step(at({place}));
    EXPECT_EQ(report.substeps, 0);
    EXPECT_FALSE(report.changed);
    EXPECT_EQ(passes.pose()->links.front().translation(), place);
    EXPECT_EQ(report.tools.front().contacts, 0);
  }
  EXPECT_EQ(greatestDisplacement(passes.tissue()), 0.0);
  Pipeline comes(block(), methodOf("elastic"), {probe()});
  for (Pipeline* pipeline : {&passes, &comes}) {
    pipeline->step(at({above}));
    walk(*pipeline, -0.001, 0.003);
  }
  const Vec3 force = comes.report().tools.front().force_on_tool;
  EXPECT_GT(force.z(), 0.1);
  // Where it comes from is some digits of its place; rounds go on from that.
  EXPECT_LT((passes.report().tools.front().force_on_tool - force).norm(), 1e-2 * force.norm());
}

TEST(PassingTool, OnItsWayThroughTheTissueItDoesNotPass) {
  Pipeline pipeline(block(), methodOf("elastic"), {probe()});
  const double height = 0.5 * kTop;
  pipeline.step(at({Vec3(kWidth + 0.05, kMiddle, height)}));
  const StepReport& report = pipeline.step(at({Vec3(-0.05, kMiddle, height)}));
  EXPECT_GT(report.substeps, 10);
}

// It asks for no more rounds of what the others press: how deep they are is the solver's answer.
TEST(PassingTool, WithARigidPatchChangesNothingOfWhatOthersPress) {
  const auto pressBeside = [](ToolConfig::Patch patch) {
    ToolGeometry other = probe("other");
    other.patch = patch;
    Pipeline pipeline(block(), methodOf("elastic"), {probe(), other});
    for (const double depth : {-0.001, 0.0062}) {
      RobotPose pose = pressed(depth);
      pose.links.push_back(at({Vec3::Ones()}).links.front());
      pipeline.step(pose);
    }
    EXPECT_GT(pipeline.report().tools.front().max_penetration, 0.0001 * kSpacing);
    return pipeline.tissue().state().displacement;
  };
  EXPECT_EQ(pressBeside(ToolConfig::Patch::kRigid), pressBeside(ToolConfig::Patch::kConforming));
}

}  // namespace
}  // namespace robot_tissue::test_still_tools
