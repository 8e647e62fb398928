// Edges of tools that cut, as rviz draws them.
#include <gtest/gtest.h>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/markers.h"

namespace robot_tissue::test_edge_lines {
namespace {

visualization_msgs::Marker edgesOf(const Pipeline& pipeline) {
  MarkerBuilder builder("tissue", {0.1, ColorBy::kNone}, {});
  builder.reach(pipeline, ros::Time(1.0));
  for (const auto& marker : builder.build(pipeline, ros::Time(1.0)).markers) {
    if (marker.ns == "tool_edges") return marker;
  }
  ADD_FAILURE() << "no marker";
  return {};
}

Pipeline withTool(const char* role) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.1, 0.1, 0.05);
  tissue.spacing = 0.01;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  ToolGeometry tool;
  tool.name = "tool";
  tool.role = toolRole(role);
  tool.links.push_back({"tool", {}});
  if (tool.role.has_edge)
    tool.blade.edge = {Vec3::Zero(), Vec3(0.0, 0.0, 0.02), Vec3(0.01, 0.0, 0.03)};
  return {tissue, SolverConfig(), {tool}};
}

RobotPose at(const Vec3& place) {
  RobotPose pose;
  pose.links.push_back(Pose::Identity());
  pose.links.front().translation() = place;
  pose.links.front().linear() = Eigen::AngleAxisd(M_PI, Vec3::UnitX()).toRotationMatrix();
  return pose;
}

TEST(EdgeLines, AreWhereTheBladeIs) {
  Pipeline pipeline = withTool("blade");
  EXPECT_EQ(edgesOf(pipeline).action, visualization_msgs::Marker::DELETE);  // it stands nowhere
  pipeline.step(at(Vec3(0.05, 0.04, 0.2)));
  const visualization_msgs::Marker lines = edgesOf(pipeline);
  EXPECT_EQ(lines.type, visualization_msgs::Marker::LINE_LIST);
  ASSERT_EQ(lines.points.size(), 4U);
  EXPECT_NEAR(lines.points[0].z, 0.2, 1e-12);
  EXPECT_NEAR(lines.points[1].z, 0.18, 1e-12);
  EXPECT_NEAR(lines.points[3].x, 0.06, 1e-12);
  EXPECT_NEAR(lines.points[3].y, 0.04, 1e-12);
  EXPECT_NEAR(lines.points[3].z, 0.17, 1e-12);
  RobotPose away;
  away.links.push_back(Pipeline::away());
  pipeline.step(away);
  EXPECT_EQ(edgesOf(pipeline).action, visualization_msgs::Marker::DELETE);
}

TEST(EdgeLines, AreNotOfToolsWithoutAnEdge) {
  Pipeline pipeline = withTool("push");
  pipeline.step(at(Vec3(0.05, 0.04, 0.2)));
  EXPECT_EQ(edgesOf(pipeline).action, visualization_msgs::Marker::DELETE);
}

}  // namespace
}  // namespace robot_tissue::test_edge_lines
