// Tools that let go of tissue that no shape follows, or that hangs on them: what is told of them.
#include <string>

#include "pipeline_fixtures.h"
#include "robot_tissue/pipeline/step_remarks.h"

namespace robot_tissue::test_stuck_tools {
namespace {

using Tools = std::vector<std::size_t>;

// What is said of that kind; empty: nothing.
std::string saidOf(StepRemark::Kind kind, const Pipeline& pipeline) {
  for (const StepRemark& remark : remarksOn(pipeline)) {
    if (remark.kind == kind) return remark.text;
  }
  return "";
}

// Its tissue is pulled into it, farther from the block's place at rest than a spacing.
TEST(HookedTool, LetsGoAndIsToldSo) {
  Pipeline pipeline(block(), SolverConfig(), {probe()});
  pipeline.step(pressed(-0.006));
  PatchConfig pulled;
  pulled.name = "pulled";
  const Vec3 reach(0.004, 0.004, 1e-6), middle(kMiddle, kMiddle, kTop);
  pulled.box = {middle - reach, middle + reach};
  pulled.displacement = {{0.0, 0.0, 0.012}};
  pipeline.load({1, {pulled}});
  ASSERT_GT(pipeline.report().tools.front().force_on_tool.norm(), 0.0);
  const StepReport& report = pipeline.step(pressed(-0.0063));
  EXPECT_EQ(report.hooked, Tools{0});
  EXPECT_TRUE(report.were_inside.empty()) << "it did not appear";
  EXPECT_TRUE(report.jammed.empty());
  EXPECT_NE(saidOf(StepRemark::Kind::kHooked, pipeline).find("'probe'"), std::string::npos);
  EXPECT_EQ(saidOf(StepRemark::Kind::kInside, pipeline), "");
  pipeline.step(pressed(-0.03));
  EXPECT_TRUE(report.hooked.empty()) << "for one update";
}

TEST(JammedTools, LetGoAndAreToldSo) {
  const ToolShape box = boxOf(Vec3(0.02, 0.02, 0.02));
  Pipeline pipeline(block("elastic", 0.01), {}, {toolOf(box, "left"), toolOf(box, "right")});
  const auto apart = [](double gap) {
    const double off = 0.5 * gap + 0.01;
    return at({Vec3(kMiddle - off, kMiddle, 0.03), Vec3(kMiddle + off, kMiddle, 0.03)});
  };
  const StepReport& report = pipeline.report();
  int lost = 0;
  for (double gap = 0.062; gap > -0.01 && report.jammed.empty(); gap -= 0.002) {
    pipeline.step(apart(gap));
    EXPECT_TRUE(report.were_inside.empty()) << gap;
    EXPECT_TRUE(report.hooked.empty()) << gap;
    lost += report.lost ? 1 : 0;
  }
  EXPECT_EQ(report.jammed, (Tools{0, 1}));
  EXPECT_GE(lost, 2) << "updates before";
  EXPECT_NE(saidOf(StepRemark::Kind::kJammed, pipeline).find("'left' and 'right'"),
            std::string::npos);
  EXPECT_EQ(saidOf(StepRemark::Kind::kInside, pipeline), "");
}

// It is behind only because they are, and only just so.
TEST(JammedTools, DoNotMakeALateOneLetGo) {
  const ToolShape box = boxOf(Vec3(0.02, 0.02, 0.02));
  Pipeline pipeline(block("elastic", 0.01), {},
                    {toolOf(box, "left"), toolOf(box, "right"), probe()});
  const auto pose = [](double gap, double depth) {
    const double off = 0.5 * gap + 0.01;
    return at({Vec3(kMiddle - off, kMiddle, 0.03), Vec3(kMiddle + off, kMiddle, 0.03),
               Vec3(kMiddle, 0.055, kTop + kRadius - depth)});
  };
  double gap = 0.062;
  for (; gap > -0.01 && !pipeline.report().lost; gap -= 0.002) pipeline.step(pose(gap, 0.002));
  ASSERT_EQ(pipeline.report().behind, (Tools{0, 1}));
  pipeline.step(pose(gap -= 0.002, 0.002));
  ASSERT_EQ(pipeline.report().behind, (Tools{0, 1}));
  pipeline.step(pose(gap - 0.002, 0.003));
  EXPECT_EQ(pipeline.report().jammed, (Tools{0, 1}));
}

// With so few iterations a load step that the tool falls far behind.
TEST(ToolBehind, ThatIsClearOfTheTissueLetsGoAndIsToldSo) {
  Pipeline pipeline(block(), SolverConfig(), {withFriction(0.5, probe())});
  walk(pipeline, -0.001, 0.012);
  pipeline.setMostIterations(3);
  const RobotPose out = pressed(-0.04);
  std::string said;
  int updates = 0;
  while (++updates < 200) {
    pipeline.step(out);
    said += saidOf(StepRemark::Kind::kTooFast, pipeline);
    if (pipeline.hasArrived() && !pipeline.report().changed) break;
  }
  EXPECT_LT(updates, 20);
  EXPECT_NE(said.find("'probe' left the tissue faster"), std::string::npos) << said;
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
  EXPECT_EQ(pipeline.report().tools.front().force_on_tool, Vec3::Zero());
}

// As long as those that have left before it.
TEST(ToolBehind, ThatLeavesAfterAnotherIsFollowedAsLong) {
  Pipeline pipeline(block(), SolverConfig(),
                    {withFriction(0.5, probe("first")), withFriction(0.5, probe("second"))});
  const auto both = [](double first, double second) {
    return std::vector<Vec3>{pressed(first, 0.015).links.front().translation(),
                             pressed(second, 0.045).links.front().translation()};
  };
  walk(pipeline, both(-0.001, -0.001), both(0.01, 0.01));
  pipeline.setMostIterations(3);
  for (int update = 1; update < 3; ++update) {
    pipeline.step(at(both(-0.04, 0.01)));
    ASSERT_EQ(pipeline.report().behind, Tools{0});
  }
  pipeline.step(at(both(-0.04, -0.04)));
  EXPECT_EQ(pipeline.report().left, Tools{0});
}

// Where the robot has it, it would meet the tissue again.
TEST(ToolBehind, ThatIsNotClearOfTheTissueIsFollowed) {
  Pipeline pipeline(block(), SolverConfig(), {withFriction(0.5, probe())});
  walk(pipeline, -0.001, 0.012);
  pipeline.setMostIterations(3);
  for (int update = 0; update < 200; ++update) {
    pipeline.step(pressed(0.002));
    ASSERT_TRUE(pipeline.report().left.empty()) << update;
  }
  EXPECT_GT(pipeline.report().tools.front().force_on_tool.z(), 0.05);
}

// A gripper has lifted one end of a ridge; no shape follows plates that close on its other end.
TEST(GripperBesideAJam, HoldsWhatItHoldsUntilItIsToldToLetGo) {
  TissueConfig tissue = ridge();
  tissue.shape.max().x() = 0.06;
  tissue.fixed = {bottomOf(tissue.shape)};
  const auto plate = [](int side) {
    return toolOf(boxOf(Vec3(0.016, 0.004, 0.01), Vec3(0.0, 0.002 * side, 0.0)));
  };
  Pipeline pipeline(tissue, {}, {ridgeGripper("gripper", 0.008, 0.012), plate(-1), plate(1)});
  const StepReport& report = pipeline.report();
  const auto step = [&](double gap, double lift, double between_plates) {
    std::vector<Vec3> origins = jawsOnRidge(gap, lift);
    for (const Vec3& origin : jawsOnRidge(between_plates)) {
      origins.push_back(origin + Vec3(0.032, 0.0, -0.002));
    }
    pipeline.step(at(origins));
  };
  constexpr double kHeld = 0.007, kLift = 0.004, kJammed = -0.006;
  for (double gap = 0.016; gap > kHeld - 1e-4; gap -= 0.0005) step(gap, 0.0, 0.016);
  for (double lift = 0.0; lift < kLift + 1e-4; lift += 0.0005) step(kHeld, lift, 0.016);
  step(kHeld, kLift, kJammed);
  ASSERT_TRUE(report.lost);
  ASSERT_TRUE(report.tools.front().grasps);
  pipeline.letGo(0);
  pipeline.grasp(0);
  step(kHeld, kLift, kJammed);
  EXPECT_TRUE(report.tools.front().grasps) << "what it was told last";
  step(kHeld, 0.016, kJammed);
  EXPECT_TRUE(report.tools.front().grasps) << "its jaws are clear of the tissue that stays behind";
  EXPECT_LT(report.tools.front().force_on_tool.z(), -0.2);
  pipeline.letGo(0);
  step(kHeld, 0.016, kJammed);
  EXPECT_FALSE(report.tools.front().grasps);
}

}  // namespace
}  // namespace robot_tissue::test_stuck_tools
