// Tools, supports and the steps that tools take arrive with every field.
#include <gtest/gtest.h>

#include "scene_texts.h"

namespace robot_tissue::test_good_tools {
namespace {

Scene toolScene() { return parseText(kToolScene, SceneUser::kRunner); }

// With the paper's model, whose method moves hard patches only.
std::string onSixSprings(const std::string& scene) {
  return replaced(scene, "  spacing: 0.01\n", "  spacing: 0.01\n  model: six_spring\n");
}

TEST(GoodTools, ABladeHasItsEdgeAndNeedsNoShapes) {
  const std::string scene =
      "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n  spacing: 0.01\n"
      "  material: {young_modulus: 1000, tear_stretch: 1.5, tear_length: 0.005}\n"
      "tools: [{name: knife, role: blade, edge: [[0, 0, 0], [0, 0.01, 0.02]], resistance: 200}]\n"
      "steps: [{move: {tool: knife, from: {xyz: [0, 0, 1]}, to: {xyz: [0, 0, 0]}}}]\n";
  const Scene read = parseText(scene, SceneUser::kRunner);
  const BladeConfig& blade = read.tools.at(0).blade;
  EXPECT_EQ(blade.edge, (std::vector<Vec3>{Vec3::Zero(), Vec3(0.0, 0.01, 0.02)}));
  EXPECT_EQ(blade.resistance, 200.0);
  EXPECT_EQ(read.steps.size(), 1U);
  EXPECT_EQ(read.tissue.material.tear_stretch, 1.5);
  EXPECT_EQ(read.tissue.material.tear_length, 0.005);
}

TEST(GoodTools, ScissorsHaveTwoEdgesAndNeedNoShapes) {
  const Scene read = parseText(
      "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n  spacing: 0.01\n"
      "  material: {young_modulus: 1000}\n"
      "tools:\n"
      "  - name: shears\n    role: scissors\n    opening_axis: [0, 0, 2]\n"
      "    edges: [[[0, 0, -0.001], [0.02, 0, 0.001]], [[0, 0, 0.001], [0.02, 0, -0.001]]]\n"
      "steps: [{move: {tool: shears, from: {xyz: [0, 0, 1], opening: 0.02},"
      " to: {xyz: [0, 0, 0], opening: 0.0}}}]\n",
      SceneUser::kRunner);
  const ToolConfig& shears = read.tools.at(0);
  EXPECT_EQ(shears.links.size(), 3U);
  EXPECT_EQ(shears.scissors.edges[0].back(), Vec3(0.02, 0.0, 0.001));
  EXPECT_EQ(shears.scissors.edges[1].front(), Vec3(0.0, 0.0, 0.001));
  EXPECT_EQ(shears.grasp.opening_axis, Vec3::UnitZ());
}

TEST(GoodTools, ALinkWithShapesHasEveryField) {
  const std::vector<ToolConfig> tools = parseText(kNodeScene, SceneUser::kNode).tools;
  ASSERT_EQ(tools.size(), 2U);
  EXPECT_EQ(tools[0].name, "probe");
  ASSERT_EQ(tools[0].links.size(), 1U);
  EXPECT_EQ(tools[0].links[0].link, "tool_tip");
  EXPECT_EQ(tools[0].links[0].padding, 0.001);
  EXPECT_EQ(tools[1].name, "other_tip");
  ASSERT_EQ(tools[1].links.size(), 1U);
  EXPECT_EQ(tools[1].links[0].link, "other_tip");
  EXPECT_TRUE(tools[1].links[0].shapes.empty());
  const std::vector<ToolShape>& shapes = tools[0].links[0].shapes;
  ASSERT_EQ(shapes.size(), 4U);
  EXPECT_EQ(shapes[0].type, ToolShape::Type::kSphere);
  EXPECT_EQ(shapes[0].radius, 0.01);
  EXPECT_EQ(shapes[0].pose.translation(), Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(shapes[1].type, ToolShape::Type::kCylinder);
  EXPECT_EQ(shapes[1].radius, 0.004);
  EXPECT_EQ(shapes[1].length, 0.05);
  EXPECT_EQ(shapes[1].padding, 0.0);
  EXPECT_TRUE(shapes[1].pose.isApprox(Pose::Identity()));
  EXPECT_EQ(shapes[2].type, ToolShape::Type::kBox);
  EXPECT_EQ(shapes[2].size, Vec3(0.01, 0.02, 0.04));
  EXPECT_EQ(shapes[3].type, ToolShape::Type::kMesh);
  EXPECT_EQ(shapes[3].resource, "package://robot_tissue/tip.stl");
  EXPECT_EQ(shapes[3].scale, Vec3(0.001, 0.001, 0.001));
}

// Roll pi/2 turns z to -y, then yaw pi/2 turns -y to x. Another order gives another axis.
TEST(GoodTools, RollPitchYawTurnAboutFixedAxes) {
  const std::string text = replaced(kNodeScene, "rpy: [0.1, 0.2, 0.3]",
                                    "rpy: [1.5707963267948966, 0.0, 1.5707963267948966]");
  const Pose pose = parseText(text, SceneUser::kNode).tools[0].links[0].shapes[0].pose;
  EXPECT_LT((pose.linear() * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((pose.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
}

TEST(GoodTools, AToolOfTheRunnerNeedsNoLink) {
  const std::vector<ToolConfig> tools = toolScene().tools;
  ASSERT_EQ(tools.size(), 5U);
  const ToolConfig& probe = tools[0];
  EXPECT_EQ(probe.name, "probe");
  EXPECT_EQ(probe.role.name, "push");
  EXPECT_EQ(probe.patch, ToolConfig::Patch::kConforming);
  EXPECT_EQ(probe.friction, 0.4);
  EXPECT_EQ(probe.max_force, 5.0);
  ASSERT_EQ(probe.links.size(), 1U);
  EXPECT_EQ(probe.links[0].link, "");
  ASSERT_EQ(probe.links[0].shapes.size(), 1U);
  EXPECT_EQ(probe.links[0].shapes[0].padding, 0.0005);
}

TEST(GoodTools, SeveralLinksKeepTheirOrderAndPaddings) {
  const std::vector<ToolConfig> tools = toolScene().tools;
  const ToolConfig& fork = tools.at(1);
  EXPECT_EQ(fork.patch, ToolConfig::Patch::kRigid);
  EXPECT_EQ(fork.friction, 0.3);
  EXPECT_EQ(fork.max_force, 0.0);
  ASSERT_EQ(fork.links.size(), 2U);
  EXPECT_EQ(fork.links[0].padding, 0.001);
  EXPECT_EQ(fork.links[0].shapes.at(0).radius, 0.002);
  EXPECT_EQ(fork.links[1].padding, 0.0);
  EXPECT_EQ(fork.links[1].shapes.at(0).radius, 0.003);
  const ToolConfig& arm = tools.at(3);
  EXPECT_EQ(arm.name, "wrist");
  ASSERT_EQ(arm.links.size(), 2U);
  EXPECT_EQ(arm.links[0].link, "wrist");
  EXPECT_TRUE(arm.links[0].collision_padding.empty());
  EXPECT_EQ(arm.links[1].link, "tip");
  EXPECT_EQ(arm.links[1].padding, 0.002);
  const std::map<std::string, double> by_collision = {{"fin", 0.003}, {"rib-1", 0.0}};
  EXPECT_EQ(arm.links[1].collision_padding, by_collision);
}

TEST(GoodTools, AGrasperIsItsOwnLinkThenItsJaws) {
  const std::vector<ToolConfig> tools = toolScene().tools;
  const ToolConfig& forceps = tools.at(2);
  EXPECT_EQ(forceps.role.name, "grasper");
  ASSERT_EQ(forceps.links.size(), 3U);
  EXPECT_EQ(forceps.links[0].link, "");
  EXPECT_TRUE(forceps.links[0].shapes.empty());
  EXPECT_EQ(forceps.links[1].shapes.at(0).type, ToolShape::Type::kBox);
  EXPECT_EQ(forceps.links[2].shapes.at(0).type, ToolShape::Type::kSphere);
  EXPECT_EQ(forceps.grasp.close_gap, 0.004);
  EXPECT_EQ(forceps.grasp.open_gap, 0.009);
  EXPECT_EQ(forceps.grasp.max_force, 2.0);
  EXPECT_EQ(forceps.grasp.opening_axis, Vec3(0.0, 0.0, -1.0));
  const ToolConfig& gripper = tools.at(4);
  EXPECT_EQ(gripper.name, "gripper");
  ASSERT_EQ(gripper.links.size(), 3U);
  EXPECT_EQ(gripper.links[0].link, "gripper");
  EXPECT_EQ(gripper.links[1].link, "left_jaw");
  EXPECT_EQ(gripper.links[2].link, "right_jaw");
}

TEST(GoodTools, AGrasperWithoutGapsTakesThemFromTheSpacing) {
  const GraspConfig grasp = toolScene().tools.at(4).grasp;
  EXPECT_EQ(grasp.close_gap, 0.01);
  EXPECT_DOUBLE_EQ(grasp.open_gap, 0.015);
  EXPECT_EQ(grasp.max_force, 0.0);
  EXPECT_EQ(grasp.opening_axis, Vec3::UnitY());
  const std::string text = replaced(kToolScene, ", open_gap: 0.009", "");
  EXPECT_DOUBLE_EQ(parseText(text, SceneUser::kRunner).tools.at(2).grasp.open_gap, 0.006);
}

// The frame of a grasper's own link may be one of its jaws'.
TEST(GoodTools, TheNodeTakesAGrasperWithAndWithoutALinkOfItsOwn) {
  const std::string jaws = "role: grasper, jaws: [left_jaw, right_jaw]}";
  for (const std::string own : {"", "link: left_jaw, "}) {
    const std::string text =
        replaced(kNodeScene, "{link: other_tip}", "{name: forceps, " + own + jaws);
    const ToolConfig forceps = parseText(text, SceneUser::kNode).tools.at(1);
    ASSERT_EQ(forceps.links.size(), 3U);
    EXPECT_EQ(forceps.links[0].link, own.empty() ? "" : "left_jaw");
    EXPECT_EQ(forceps.links[2].link, "right_jaw");
  }
}

TEST(GoodTools, OnSixSpringsAToolIsRigid) {
  const Scene scene = parseText(onSixSprings(kNodeScene), SceneUser::kNode);
  EXPECT_EQ(scene.tools.at(1).patch, ToolConfig::Patch::kRigid);
  EXPECT_TRUE(scene.remarks.empty());
  const std::string told = replaced(kNodeScene, "role: push", "patch: rigid");
  const ToolConfig tool = parseText(onSixSprings(told), SceneUser::kNode).tools.at(0);
  EXPECT_EQ(tool.patch, ToolConfig::Patch::kRigid);
}

TEST(GoodTools, WhatIsIgnoredIsSaid) {
  std::string text = replaced(kToolScene, "patch: rigid", "patch: rigid\n    friction: 0.2");
  text = replaced(text, "padding: 0.001, shapes", "collision_padding: {a: 0.1}, shapes");
  const std::vector<std::string> remarks = parseText(text, SceneUser::kRunner).remarks;
  ASSERT_EQ(remarks.size(), 2U);
  EXPECT_NE(remarks[0].find("tools[1].links[0].collision_padding = {a: 0.1}: ignored"),
            std::string::npos)
      << remarks[0];
  EXPECT_NE(remarks[1].find("tools[1].friction = 0.2: ignored, a rigid patch sticks"),
            std::string::npos)
      << remarks[1];
  const std::string axis = replaced(kNodeScene, "{link: other_tip}",
                                    "{link: base, role: grasper, jaws: [left, right], grasp: "
                                    "{opening_axis: [1, 0, 0]}}");
  const std::vector<std::string> in_node = parseText(axis, SceneUser::kNode).remarks;
  ASSERT_EQ(in_node.size(), 1U);
  EXPECT_NE(in_node[0].find("tools[1].grasp.opening_axis = [1, 0, 0]: ignored"), std::string::npos);
  EXPECT_TRUE(toolScene().remarks.empty());
}

TEST(GoodTools, SupportsHaveEveryField) {
  const std::vector<SupportConfig> supports = toolScene().supports;
  ASSERT_EQ(supports.size(), 2U);
  EXPECT_EQ(supports[0].name, "table");
  EXPECT_EQ(supports[0].friction, 0.5);
  EXPECT_EQ(supports[0].shape.type, ToolShape::Type::kPlane);
  EXPECT_EQ(supports[0].shape.pose.translation(), Vec3(0.05, 0.04, -0.01));
  EXPECT_TRUE(supports[0].shape.pose.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-15));
  EXPECT_EQ(supports[1].name, "support_2");
  EXPECT_EQ(supports[1].friction, 0.3);
  EXPECT_EQ(supports[1].shape.type, ToolShape::Type::kBox);
  EXPECT_TRUE(supports[1].shape.size.isApprox(Vec3(0.02, 0.1, 0.06), 1e-15));
  EXPECT_TRUE(supports[1].shape.pose.translation().isApprox(Vec3(0.11, 0.05, 0.03), 1e-15));
  EXPECT_TRUE(supports[1].shape.pose.linear().isApprox(Eigen::Matrix3d::Identity()));
}

TEST(GoodTools, APlanesZAxisIsItsNormal) {
  for (const auto& [text, normal] :
       {std::pair("[0, 0, -1]", Vec3(0, 0, -1)), std::pair("[3, 0, 4]", Vec3(0.6, 0, 0.8))}) {
    const std::string scene = replaced(kToolScene, "[0.0, 0.0, 2.0]", text);
    const Scene parsed = parseText(scene, SceneUser::kRunner);
    const Eigen::Matrix3d turn = parsed.supports.at(0).shape.pose.linear();
    EXPECT_LT((turn.col(2) - normal).norm(), 1e-14) << text;
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14) << text;
    EXPECT_NEAR(turn.determinant(), 1.0, 1e-14) << text;
  }
}

TEST(GoodTools, TheNodeHasSupportsToo) {
  const std::string text = kNodeScene + "supports: [{type: box, min: [0, 0, -1], max: [1, 1, 0]}]";
  const Scene scene = parseText(text, SceneUser::kNode);
  ASSERT_EQ(scene.supports.size(), 1U);
  EXPECT_EQ(scene.supports[0].name, "support_1");
  EXPECT_NO_THROW(parseText(onSixSprings(kNodeScene) + "supports: []", SceneUser::kNode));
}

TEST(GoodTools, SupportsMayBearTissueThatNothingFixes) {
  const std::string heavy = replaced(kNodeScene, "tools:", "  gravity: [0, 0, -9.81]\ntools:");
  const std::string table = "supports: [{type: plane, point: [0, 0, 0], normal: [0, 0, 1]}]\n";
  EXPECT_EQ(refusal(heavy + table, SceneUser::kNode), "");
  for (const std::string& none : {std::string(), std::string("supports: []\n")}) {
    const std::string message = refusal(heavy + none, SceneUser::kNode);
    EXPECT_NE(message.find("tissue.gravity = [0, 0, -9.81]"), std::string::npos) << message;
  }
}

TEST(GoodTools, StepsHaveEveryField) {
  const std::vector<Step> steps = toolScene().steps;
  ASSERT_EQ(steps.size(), 7U);
  const auto& press = std::get<MoveStep>(steps[0]);
  EXPECT_EQ(press.tool, "probe");
  ASSERT_TRUE(press.from.has_value());
  EXPECT_EQ(press.from->pose.translation(), Vec3(0.05, 0.05, 0.07));
  EXPECT_LT((press.from->pose.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(press.to.pose.translation(), Vec3(0.05, 0.05, 0.055));
  EXPECT_TRUE(press.to.pose.linear().isApprox(Eigen::Matrix3d::Identity()));
  EXPECT_EQ(press.increments.value_or(0), 20);
  const auto& push = std::get<PushStep>(steps[1]);
  EXPECT_EQ(push.tool, "probe");
  EXPECT_EQ(push.force, Vec3(0.0, 0.5, -1.0));
  EXPECT_EQ(push.increments.value_or(0), 4);
  const auto& close = std::get<MoveStep>(steps[2]);
  ASSERT_TRUE(close.from.has_value());
  EXPECT_EQ(close.from->opening, 0.01);
  EXPECT_EQ(close.to.opening, 0.0);
  EXPECT_FALSE(close.increments.has_value());
  EXPECT_EQ(std::get<GraspStep>(steps[3]).tool, "forceps");
  const auto& lift = std::get<MoveStep>(steps[4]);
  EXPECT_FALSE(lift.from.has_value());
  EXPECT_EQ(lift.to.opening, 0.002);
  const auto& release = std::get<ReleaseStep>(steps[5]);
  EXPECT_EQ(release.tools, std::vector<std::string>({"forceps", "probe"}));
  EXPECT_TRUE(release.patches.empty());
}

TEST(GoodTools, AToolStillStandsAfterItsRelease) {
  const std::string text =
      replaced(kToolScene, "- reset: {}", "- move: {tool: probe, to: {xyz: [0, 0, 0.1]}}");
  EXPECT_EQ(refusal(text, SceneUser::kRunner), "");
}

// Shapes of their own may lie apart: told, not refused. A grasper's frame touches nothing.
TEST(GoodTools, ALinkOfTwoToolsWithShapesIsRemarkedOn) {
  const std::string second = "  - {link: other_tip}\n  - {name: second, link: tool_tip}\n";
  const Scene scene =
      parseText(replaced(kNodeScene, "  - {link: other_tip}\n", second), SceneUser::kNode);
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_NE(scene.remarks[0].find("tools[2].link = tool_tip: is a link of tool 'probe' already"),
            std::string::npos)
      << scene.remarks[0];
  const std::string frame =
      "  - {link: other_tip}\n  - {name: g, link: other_tip, role: grasper, jaws: [left, right]}\n";
  EXPECT_TRUE(parseText(replaced(kNodeScene, "  - {link: other_tip}\n", frame), SceneUser::kNode)
                  .remarks.empty());
}

}  // namespace
}  // namespace robot_tissue::test_good_tools
