// What the node has as a bound of a load step, and says of contacts that still settle, and of tools
// that let go.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>

#include "robot_tissue/pipeline/step_remarks.h"
#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/node_status.h"

namespace robot_tissue::test_late_status {
namespace {

NodeParameters parametersWith(const std::string& solver) {
  const std::string tissue =
      "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.06, 0.04]}\n  spacing: 0.005\n"
      "  material: {young_modulus: 10000.0}\n  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, "
      "1.0e-6]}]\n";
  return parseNodeParameters(YAML::Load(tissue + solver), SceneSource());
}

TEST(LateStatus, LoadStepsOfTheDefaultMethodAreBounded) {
  EXPECT_GT(mostIterations(parametersWith("")), 0);
  EXPECT_EQ(mostIterations(parametersWith("solver: {max_iterations: 7}")), 7);
  EXPECT_EQ(mostIterations(parametersWith("solver: {max_iterations: 0}")), 0);
  EXPECT_EQ(mostIterations(parametersWith("solver: {method: newton}")), 0);
}

TEST(LateStatus, ContactsThatStillSettleAreNoLackOfTime) {
  const NodeParameters parameters = parametersWith("");
  ToolShape box;
  box.type = ToolShape::Type::kBox;
  box.size = Vec3::Constant(0.02);
  box.pose.linear() = Eigen::AngleAxisd(0.25 * M_PI, Vec3::UnitY()).toRotationMatrix();
  ToolGeometry tool;
  tool.name = "edge";
  tool.friction = 0.3;
  tool.links.push_back({"edge", {box}});
  Pipeline pipeline(parameters.scene.tissue, parameters.scene.solver, {tool});
  pipeline.setMostIterations(12);
  int settling = 0;
  for (int step = 0; step <= 100; ++step) {
    const double gone = 0.00025 * step, depth = std::min(gone, 0.008);
    RobotPose pose;
    pose.links.push_back(Pose(
        Eigen::Translation3d(0.0213 + gone - depth, 0.0311, 0.04 + 0.01 * std::sqrt(2.0) - depth)));
    const StepReport& report = pipeline.step(pose);
    const NodeStatus status = statusOf(pipeline, remarksOn(pipeline));
    if (!report.late || report.too_fast) continue;
    ++settling;
    EXPECT_EQ(status.status, "LATE");
    EXPECT_NE(status.message.find("contacts still settle"), std::string::npos) << status.message;
    EXPECT_EQ(status.message.find("max_ms"), std::string::npos) << status.message;
  }
  EXPECT_GT(settling, 0);
}

TEST(Status, AnswersOfServicesTellASolveThatIsNotInBalance) {
  NodeParameters parameters = parametersWith("solver: {method: layered}");
  Pipeline pipeline(parameters.scene.tissue, parameters.scene.solver, {});
  SolveReport solve;
  EXPECT_EQ(endOfAnswer(solve, pipeline), "");
  solve.status = SolveStatus::kUnconverged;
  EXPECT_EQ(endOfAnswer(solve, pipeline), "; UNCONVERGED");
  pipeline.setBudget(1e-9);
  LoadStep load;
  PatchConfig patch;
  patch.name = "pull";
  patch.box = Box(Vec3(0.0, 0.0, 0.04), Vec3(0.06, 0.06, 0.04));
  patch.displacement = {{0.0, 0.0, 0.002}};
  load.patches.push_back(patch);
  pipeline.load(
      load, [&](int, int, const SolveReport& report) { solve = report; }, 1);
  ASSERT_TRUE(pipeline.isLate());
  EXPECT_EQ(endOfAnswer(solve, pipeline), "; LATE, carried on");
}

TEST(Status, ToolsThatLetGoDidNotAppearInside) {
  const NodeParameters parameters = parametersWith("");
  const Pipeline pipeline(parameters.scene.tissue, parameters.scene.solver, {});
  using Kind = StepRemark::Kind;
  EXPECT_EQ(statusOf(pipeline, {}).status, "OK");
  EXPECT_EQ(statusOf(pipeline, {{Kind::kInside, "a"}}).status, "INSIDE");
  EXPECT_EQ(statusOf(pipeline, {{Kind::kHooked, "a"}, {Kind::kInside, "b"}}).status, "HOOKED");
  EXPECT_EQ(statusOf(pipeline, {{Kind::kJammed, "a"}, {Kind::kTornOff, "b"}}).status, "JAMMED");
}

}  // namespace
}  // namespace robot_tissue::test_late_status
