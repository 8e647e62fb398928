// Graspers whose jaws are closed when they meet tissue: they hold none of it until they have
// opened.
#include "pipeline_fixtures.h"

namespace robot_tissue::test_closed_jaws {
namespace {

constexpr double kCloseGap = 0.0085;  // m
constexpr double kOpenGap = 0.0095;   // m

const ToolReport& toolOf(const Pipeline& pipeline) { return pipeline.report().tools.front(); }

bool says(const Pipeline& pipeline, const std::string& words) {
  return toolOf(pipeline).holds_nothing.find(words) != std::string::npos;
}

Pipeline aroundRidge() {
  return {ridge(), SolverConfig(), {ridgeGripper("gripper", kCloseGap, kOpenGap)}};
}

// Two thin plates above the middle of the block, with their lower ends this deep in it (m).
constexpr double kThickness = 0.003;  // m

ToolGeometry tweezers() {
  ToolGeometry tool;
  tool.name = "tweezers";
  tool.role = toolRole("grasper");
  const Vec3 plate(0.008, kThickness, 0.012);
  tool.links = {{"left", {boxOf(plate, Vec3(0.0, -0.5 * kThickness, 0.006))}},
                {"right", {boxOf(plate, Vec3(0.0, 0.5 * kThickness, 0.006))}}};
  tool.grasp.close_gap = kCloseGap;
  tool.grasp.open_gap = kOpenGap;
  return tool;
}

std::vector<Vec3> inBlock(double gap, double depth) {
  return {Vec3(kMiddle, kMiddle - 0.5 * gap, kTop - depth),
          Vec3(kMiddle, kMiddle + 0.5 * gap, kTop - depth)};
}

// Opens and closes around tissue, which it holds then.
void expectToHoldOnceOpened(Pipeline& pipeline) {
  walk(pipeline, jawsOnRidge(0.008), jawsOnRidge(0.014));
  walk(pipeline, jawsOnRidge(0.014), jawsOnRidge(0.008));
  EXPECT_TRUE(toolOf(pipeline).grasps) << toolOf(pipeline).holds_nothing;
}

TEST(ClosedJaws, ThatPressedBeforeAResetHoldNothing) {
  Pipeline pipeline(block(), SolverConfig(), {tweezers()});
  walk(pipeline, inBlock(0.006, -0.004), inBlock(0.006, 0.003));
  ASSERT_FALSE(toolOf(pipeline).grasps);
  for (int resets = 0; resets < 2; ++resets) {
    pipeline.reset();
    pipeline.step(at(inBlock(0.006, 0.003)));
    EXPECT_FALSE(toolOf(pipeline).grasps) << resets;
    EXPECT_FALSE(pipeline.report().lost) << resets;
  }
}

TEST(ClosedJaws, ThatHeldBeforeAResetHoldNothingUntilTheyOpen) {
  Pipeline pipeline = aroundRidge();
  walk(pipeline, jawsOnRidge(0.014), jawsOnRidge(0.008));
  ASSERT_TRUE(toolOf(pipeline).grasps);
  pipeline.reset();
  pipeline.step(at(jawsOnRidge(0.008)));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_TRUE(says(pipeline, "grasp.open_gap")) << toolOf(pipeline).holds_nothing;
  pipeline.step(at(jawsOnRidge(0.0079)));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  expectToHoldOnceOpened(pipeline);
}

TEST(ClosedJaws, HoldNothingOfALoadedStateUntilTheyOpen) {
  Pipeline pipeline = aroundRidge();
  const std::string state = pipeline.tissue().savedState();
  walk(pipeline, jawsOnRidge(0.014), jawsOnRidge(0.008));
  pipeline.loadState(state);
  pipeline.step(at(jawsOnRidge(0.008)));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  expectToHoldOnceOpened(pipeline);
}

TEST(ClosedJaws, ThatAppearPressingHoldNothing) {
  Pipeline pipeline(block(), SolverConfig(), {tweezers()});
  pipeline.step(at(inBlock(0.006, 0.003)));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_FALSE(pipeline.report().lost);
}

// Each from its side they would crush it.
TEST(ShutJaws, ThatAppearInTissueComeDownOnItAsOne) {
  Pipeline pipeline = aroundRidge();
  pipeline.step(at(jawsOnRidge(0.0, 0.004)));  // 6 mm deep, 4 mm from either side
  EXPECT_FALSE(pipeline.report().lost);
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_GT(toolOf(pipeline).force_on_tool.z(), 0.05) << "pressed up";
}

// Its tips push, but nothing is between them.
TEST(ClosedJaws, AskedToGraspWhatTheirTipsPressRefuse) {
  Pipeline pipeline(block(), SolverConfig(), {tweezers()});
  walk(pipeline, inBlock(0.006, -0.004), inBlock(0.006, 0.002));
  ASSERT_GT(toolOf(pipeline).force_on_tool.norm(), 0.0);
  EXPECT_TRUE(says(pipeline, "no tissue is between its jaws")) << toolOf(pipeline).holds_nothing;
  EXPECT_THROW(pipeline.grasp(0), InputError);
  EXPECT_FALSE(toolOf(pipeline).grasps);
}

}  // namespace
}  // namespace robot_tissue::test_closed_jaws
