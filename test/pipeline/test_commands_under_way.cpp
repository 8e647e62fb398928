// What tools are told while a load step is under way, in which they do what they did before.
#include "pipeline_fixtures.h"

namespace robot_tissue::test_commands_under_way {
namespace {

const ToolReport& tool(const Pipeline& pipeline) { return pipeline.report().tools.front(); }

// Steps on until the tools stay where they are, in a load step that takes another update.
template <class PoseOf>
::testing::AssertionResult comesUnderWay(Pipeline& pipeline, const PoseOf& pose_of) {
  for (int i = 1; i <= 100; ++i) {
    const std::vector<Vec3> before = pipeline.tissue().state().displacement;
    const StepReport& report = pipeline.step(pose_of(i));
    if (report.too_fast && !report.lost && pipeline.tissue().state().displacement == before) {
      return ::testing::AssertionSuccess();
    }
  }
  return ::testing::AssertionFailure() << "no load step takes a second update";
}

// Of jaws that hold and let go only when they are told to.
class GraspUnderWay : public ::testing::Test {
 protected:
  Pipeline pipeline_{ridge(), methodOf("elastic"), {ridgeGripper("gripper", 0.0, 1.0)}};
  RobotPose there_ = at(jawsOnRidge(0.008, 0.008));

  void close() { walk(pipeline_, jawsOnRidge(0.014), jawsOnRidge(0.008)); }
  void pull() {
    pipeline_.setMostIterations(1);
    ASSERT_TRUE(comesUnderWay(pipeline_, [&](int) { return there_; }));
  }
};

TEST_F(GraspUnderWay, ToolToldToLetGoHoldsNothingAnyMore) {
  close();
  pipeline_.grasp(0);
  pull();
  ASSERT_TRUE(tool(pipeline_).grasps);
  pipeline_.letGo(0);
  for (int i = 0; i < 20; ++i) {
    pipeline_.step(there_);
    EXPECT_FALSE(tool(pipeline_).grasps) << i;
  }
}

TEST_F(GraspUnderWay, ToolToldToHoldHolds) {
  close();
  pull();
  ASSERT_FALSE(tool(pipeline_).grasps);
  pipeline_.grasp(0);
  for (int i = 0; i < 20; ++i) {
    pipeline_.step(there_);
    EXPECT_TRUE(tool(pipeline_).grasps) << i;
  }
}

// A box on its edge, off which tissue slips once a spacing.
ToolGeometry edge() {
  ToolShape box = boxOf(Vec3::Constant(0.02));
  box.pose.linear() = Eigen::AngleAxisd(0.25 * M_PI, Vec3::UnitY()).toRotationMatrix();
  box.pose.translation().z() = 0.01 * std::sqrt(2.0);
  return withFriction(0.3, toolOf(box));
}

RobotPose edgeAt(double x, double depth) { return at({Vec3(x, kMiddle + 0.0011, kTop - depth)}); }

// Where nothing rubs, no force is across the drag.
TEST(FrictionUnderWay, IsThatOfTheSteps) {
  Pipeline pipeline(block(), methodOf("elastic"), {edge()});
  constexpr double kDepth = 0.004, kStart = 0.0213;
  walk(pipeline, {edgeAt(kStart, -0.001).links.front().translation()},
       {edgeAt(kStart, kDepth).links.front().translation()});
  double x = kStart;
  for (int i = 0; i < 4; ++i) pipeline.step(edgeAt(x += 0.0008, kDepth));
  pipeline.setMostIterations(2);
  ASSERT_TRUE(comesUnderWay(pipeline, [&](int) { return edgeAt(x += 0.0008, kDepth); }));
  ASSERT_GT(std::abs(tool(pipeline).force_on_tool.x()), 0.1 * tool(pipeline).force_on_tool.z());
  pipeline.setFriction(0.0);
  pipeline.setMostIterations(0);
  for (int i = 0; i < 8; ++i) pipeline.step(edgeAt(x += 0.0008, kDepth));
  EXPECT_LT(std::abs(tool(pipeline).force_on_tool.x()), 0.05 * tool(pipeline).force_on_tool.z());
}

}  // namespace
}  // namespace robot_tissue::test_commands_under_way
