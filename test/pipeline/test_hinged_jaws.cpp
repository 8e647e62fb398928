// Graspers whose jaws overlap at their hinge: the gap counts where tissue is. And what a grasper
// says that holds nothing.
#include <gtest/gtest.h>

#include "../contact/contact_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_hinged_jaws {
namespace {

constexpr double kCloseGap = 0.0085;  // m
constexpr double kOpenGap = 0.0095;   // m
const Vec3 kHinge(0.015, 0.5 * kRidge, kRidgeTop + 0.027);

ToolGeometry forceps(const ToolShape& left, const ToolShape& right) {
  ToolGeometry tool;
  tool.name = "forceps";
  tool.role = toolRole("grasper");
  tool.links = {{"left", {left}}, {"right", {right}}};
  tool.grasp.close_gap = kCloseGap;
  tool.grasp.open_gap = kOpenGap;
  return tool;
}

// Each jaw reaches 35 mm down from the hinge and 5 mm beyond it, where it always is in the other.
const Vec3 kJaw(0.008, 0.003, 0.04);
const Vec3 kLeftCenter(0.0, -0.0015, -0.015);
const Vec3 kRightCenter(0.0, 0.0015, -0.015);

ToolGeometry hingedBoxes() { return forceps(boxOf(kJaw, kLeftCenter), boxOf(kJaw, kRightCenter)); }

ToolGeometry hingedMeshes() {
  return forceps(mesh(writeStl("left_jaw.stl", boxTriangles(kJaw, kLeftCenter))),
                 mesh(writeStl("right_jaw.stl", boxTriangles(kJaw, kRightCenter))));
}

// Each jaw turned by an angle (degrees) about the hinge, which is lifted (m).
RobotPose opened(double angle, double lift = 0.0) {
  RobotPose pose;
  for (const double sign : {-1.0, 1.0}) {
    pose.links.push_back(Pose::Identity());
    pose.links.back().translation() = kHinge + Vec3(0.0, 0.0, lift);
    pose.links.back().rotate(Eigen::AngleAxisd(sign * angle * M_PI / 180.0, Vec3::UnitX()));
  }
  return pose;
}

void turn(Pipeline& pipeline, double from, double to, double lift = 0.0) {
  const int count = static_cast<int>(std::ceil(std::abs(to - from) / 0.5));
  for (int i = 1; i <= count; ++i) pipeline.step(opened(from + (to - from) * i / count, lift));
}

void lift(Pipeline& pipeline, double angle, double from, double to) {
  const int count = static_cast<int>(std::ceil(std::abs(to - from) / 0.0005));
  for (int i = 1; i <= count; ++i) pipeline.step(opened(angle, from + (to - from) * i / count));
}

const ToolReport& toolOf(const Pipeline& pipeline) { return pipeline.report().tools.front(); }

bool says(const Pipeline& pipeline, const std::string& words) {
  return toolOf(pipeline).holds_nothing.find(words) != std::string::npos;
}

constexpr double kOpen = 20.0, kHalf = 12.0, kClosed = 7.5;  // degrees: 18, 11 and 7 mm at the top

class HingedJaws : public ::testing::TestWithParam<bool> {
 protected:
  Pipeline pipeline_{ridge(), {}, {GetParam() ? hingedMeshes() : hingedBoxes()}};
};

TEST_P(HingedJaws, HoldWhatIsBetweenThemAndLetGo) {
  turn(pipeline_, kOpen, kHalf);
  EXPECT_FALSE(toolOf(pipeline_).grasps);
  ASSERT_TRUE(toolOf(pipeline_).jaw_gap.has_value());
  EXPECT_GT(*toolOf(pipeline_).jaw_gap, kOpenGap);
  turn(pipeline_, kHalf, kClosed);
  ASSERT_TRUE(toolOf(pipeline_).grasps) << toolOf(pipeline_).holds_nothing;
  EXPECT_LT(*toolOf(pipeline_).jaw_gap, kCloseGap);
  EXPECT_EQ(toolOf(pipeline_).holds_nothing, "");
  EXPECT_FALSE(toolOf(pipeline_).jaws_overlap);  // by make, not by closing
  lift(pipeline_, kClosed, 0.0, 0.003);
  EXPECT_TRUE(toolOf(pipeline_).grasps);
  EXPECT_LT(toolOf(pipeline_).force_on_tool.norm(), 3.0);
  EXPECT_LT(pipeline_.forceBalance().fixed.z(), -0.05);  // the ridge is drawn up
  turn(pipeline_, kClosed, kOpen, 0.003);
  EXPECT_FALSE(toolOf(pipeline_).grasps);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
}

TEST_P(HingedJaws, NormalIsOfTheFirstJaw) {
  turn(pipeline_, kOpen, kClosed);
  ASSERT_TRUE(toolOf(pipeline_).grasps);
  EXPECT_NEAR(toolOf(pipeline_).normal.norm(), 1.0, 1e-9);
  EXPECT_GT(toolOf(pipeline_).normal.y(), 0.8);
}

TEST_P(HingedJaws, ThatClosedOnNothingHoldNothingAndSayWhy) {
  lift(pipeline_, kOpen, 0.06, 0.05);
  turn(pipeline_, kOpen, 0.0, 0.05);
  EXPECT_TRUE(says(pipeline_, "no tissue is between its jaws")) << toolOf(pipeline_).holds_nothing;
  lift(pipeline_, 0.0, 0.05, 0.006);  // closed, 2 mm into the ridge's top
  EXPECT_GT(toolOf(pipeline_).contacts, 0);
  EXPECT_FALSE(toolOf(pipeline_).grasps);
  EXPECT_NE(toolOf(pipeline_).holds_nothing, "");
}

TEST_P(HingedJaws, ThatPressAndAreNotCloseEnoughSayWhy) {
  turn(pipeline_, kOpen, 9.8);
  EXPECT_FALSE(toolOf(pipeline_).grasps);
  EXPECT_TRUE(says(pipeline_, "grasp.close_gap (0.0085 m)")) << toolOf(pipeline_).holds_nothing;
}

INSTANTIATE_TEST_SUITE_P(Shape, HingedJaws, ::testing::Bool(),
                         [](const auto& row) { return std::string(row.param ? "Mesh" : "Box"); });

// Plates with their inner faces `gap` apart around the ridge's upper part.
ToolGeometry plates() {
  const Vec3 plate(0.016, 0.004, 0.01);
  return forceps(boxOf(plate, Vec3(0.0, -0.002, 0.0)), boxOf(plate, Vec3(0.0, 0.002, 0.0)));
}

std::vector<Vec3> apart(double gap, double lift = 0.0) {
  return {Vec3(0.015, 0.5 * (kRidge - gap), kRidgeTop - 0.005 + lift),
          Vec3(0.015, 0.5 * (kRidge + gap), kRidgeTop - 0.005 + lift)};
}

TEST(EmptyJaws, ToldToLetGoStayEmptyUntilTheyOpen) {
  Pipeline pipeline(ridge(), {}, {plates()});
  walk(pipeline, apart(0.014), apart(0.008));
  ASSERT_TRUE(toolOf(pipeline).grasps);
  pipeline.letGo(0);
  walk(pipeline, apart(0.008), apart(0.0079));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_TRUE(says(pipeline, "told to let go")) << toolOf(pipeline).holds_nothing;
  walk(pipeline, apart(0.0079), apart(0.014));
  EXPECT_EQ(toolOf(pipeline).holds_nothing, "");
  walk(pipeline, apart(0.014), apart(0.008));
  EXPECT_TRUE(toolOf(pipeline).grasps) << toolOf(pipeline).holds_nothing;
}

TEST(EmptyJaws, ThatWereClosedBeforeSaySo) {
  ToolGeometry tool = plates();
  tool.grasp.close_gap = 0.012;
  tool.grasp.open_gap = 0.013;
  Pipeline pipeline(ridge(), {}, {tool});
  walk(pipeline, apart(0.011, 0.04), apart(0.011, 0.03));
  EXPECT_TRUE(says(pipeline, "no tissue is between its jaws")) << toolOf(pipeline).holds_nothing;
  walk(pipeline, apart(0.011, 0.03), apart(0.011));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_TRUE(says(pipeline, "closed before tissue")) << toolOf(pipeline).holds_nothing;
  EXPECT_TRUE(says(pipeline, "grasp.open_gap (0.013 m)")) << toolOf(pipeline).holds_nothing;
  walk(pipeline, apart(0.011), apart(0.014));
  walk(pipeline, apart(0.014), apart(0.0115));
  EXPECT_TRUE(toolOf(pipeline).grasps) << toolOf(pipeline).holds_nothing;
}

TEST(EmptyJaws, AroundWhatIsFixedSaySo) {
  TissueConfig fixed = ridge();
  fixed.fixed.front().max().z() = kRidgeTop;
  ToolGeometry tool = plates();
  tool.grasp.close_gap = 0.012;
  tool.grasp.open_gap = 0.013;
  Pipeline pipeline(fixed, {}, {tool});
  walk(pipeline, apart(0.014), apart(0.011));
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_TRUE(says(pipeline, "fixed")) << toolOf(pipeline).holds_nothing;
}

TEST(EmptyJaws, ToldToGraspNothingRefuseWithTheReason) {
  Pipeline pipeline(ridge(), {}, {hingedBoxes()});
  pipeline.step(opened(kOpen, 0.05));
  try {
    pipeline.grasp(0);
    ADD_FAILURE() << "held something";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no tissue is between its jaws"), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(says(pipeline, "no tissue is between its jaws"));
}

// The tissue hangs on the nodes that are held and goes through the jaws as these turn away.
TEST(EmptyJaws, ToldToLetGoAreLeftByTissueThatWentThroughThem) {
  Pipeline pipeline(ridge(), {}, {plates()});
  walk(pipeline, apart(0.014), apart(0.006));
  walk(pipeline, apart(0.006), apart(0.006, 0.015));
  ASSERT_TRUE(toolOf(pipeline).grasps);
  pipeline.letGo(0);
  const StepReport& report = pipeline.step(robot_tissue::at(apart(0.006, 0.015)));
  EXPECT_FALSE(report.lost);
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
}

// On its way back, past a tool that stays, the tissue goes farther than any load step takes it.
TEST(EmptyJaws, ToldToLetGoAreLeftByTissueThatSpringsBackFar) {
  TissueConfig fine = ridge();
  fine.spacing = 0.5 * kSpacing;
  constexpr double kLift = 0.03;  // m: 12 spacings
  constexpr double kDepth = 0.006;
  const auto beside = [](std::vector<Vec3> jaws) {
    jaws.push_back(Vec3(0.03 + kRadius - kDepth, 0.5 * kRidge, 0.01));
    return jaws;
  };
  Pipeline pipeline(fine, {}, {plates(), probe()});
  walk(pipeline, beside(apart(0.014)), beside(apart(0.008)));
  walk(pipeline, beside(apart(0.008)), beside(apart(0.008, kLift)), 0.001);
  ASSERT_TRUE(toolOf(pipeline).grasps);
  ASSERT_FALSE(pipeline.report().lost);
  pipeline.letGo(0);
  const StepReport& report = pipeline.step(robot_tissue::at(beside(apart(0.008, kLift))));
  EXPECT_FALSE(report.lost);
  EXPECT_FALSE(toolOf(pipeline).grasps);
  EXPECT_NEAR(greatestDisplacement(pipeline.tissue()), kDepth, 0.1 * kDepth);
}

}  // namespace
}  // namespace robot_tissue::test_hinged_jaws
