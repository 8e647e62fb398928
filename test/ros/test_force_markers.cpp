// Arrows and numbers of forces, as rviz draws them: of the pose that they belong to, or dimmed.
#include <gtest/gtest.h>

#include <string>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/markers.h"

namespace robot_tissue::test_force_markers {
namespace {

using visualization_msgs::Marker;

constexpr double kTop = 0.04, kRadius = 0.01;  // m

TissueConfig block() {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.08, 0.08, kTop);
  tissue.spacing = 0.01;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  return tissue;
}

ToolGeometry sphere() {
  ToolShape shape;
  shape.type = ToolShape::Type::kSphere;
  shape.radius = kRadius;
  ToolGeometry tool;
  tool.name = "sphere";
  tool.role = toolRole("push");
  tool.links.push_back({"sphere", {shape}});
  return tool;
}

// Pressed in, or above.
RobotPose sphereAt(double depth) {
  RobotPose pose;
  pose.links.push_back(Pose::Identity());
  pose.links.front().translation() = Vec3(0.042, 0.042, kTop + kRadius - depth);
  return pose;
}

class ForceMarkers : public testing::Test {
 protected:
  static Marker only(const visualization_msgs::MarkerArray& array, const std::string& name) {
    for (const Marker& marker : array.markers) {
      if (marker.ns == name) return marker;
    }
    return {};
  }
  Marker drawn(const Pipeline& pipeline, const std::string& name, double now) {
    return only(builder_.build(pipeline, ros::Time(now)), name);
  }

  MarkerBuilder builder_{"tissue", {0.1, ColorBy::kNone}, {}};
};

TEST_F(ForceMarkers, AreOfThePoseReachedAndDimmedOnceTheToolIsElsewhere) {
  Pipeline pipeline(block(), SolverConfig(), {sphere()});
  pipeline.step(sphereAt(-0.001));
  pipeline.step(sphereAt(0.004));
  ASSERT_TRUE(pipeline.hasArrived());
  EXPECT_TRUE(builder_.reach(pipeline, ros::Time(1.0)).forces);
  const Marker pressed = drawn(pipeline, "force_labels", 1.0);
  const Marker arrow = drawn(pipeline, "contact_forces", 1.0);
  ASSERT_NE(pressed.text, "");
  EXPECT_GT(arrow.points.at(1).z, arrow.points.at(0).z);  // it pushes the sphere out
  EXPECT_TRUE(arrow.frame_locked) << "it goes along where the tissue's frame moves";

  pipeline.setBudget(1e-6);  // a load step an update
  pipeline.step(sphereAt(-0.02));
  ASSERT_FALSE(pipeline.hasArrived());
  const double on_the_way = pipeline.report().tools[0].force_on_tool.norm();
  const double told = std::stod(pressed.text);
  ASSERT_GT(std::abs(on_the_way - told), 0.02) << "the force on the way would do as well";
  EXPECT_EQ(drawn(pipeline, "force_labels", 1.01).text, pressed.text);
  const Marker late = drawn(pipeline, "contact_forces", 1.01);
  EXPECT_EQ(late.header.stamp, ros::Time(1.0));
  EXPECT_EQ(late.points, arrow.points) << "from where the tool was then";

  EXPECT_TRUE(builder_.fallBehind(pipeline));
  EXPECT_FALSE(builder_.fallBehind(pipeline)) << "no news";
  const Marker behind = drawn(pipeline, "force_labels", 1.2);
  EXPECT_EQ(behind.text, "(" + pressed.text + ")");
  EXPECT_NE(behind.color, pressed.color);
  EXPECT_LT(drawn(pipeline, "contact_forces", 1.2).color.a, arrow.color.a);
  EXPECT_NE(drawn(pipeline, "force_list", 1.2).text.find("earlier"), std::string::npos);
  EXPECT_EQ(drawn(pipeline, "surface", 1.2).header.stamp, ros::Time(1.2));

  for (int update = 0; update < 100 && !pipeline.hasArrived(); ++update) {
    pipeline.step(sphereAt(-0.02));
  }
  ASSERT_TRUE(pipeline.hasArrived());
  EXPECT_TRUE(builder_.reach(pipeline, ros::Time(1.3)).any());
  for (const char* name : {"force_labels", "contact_forces", "contact_normals", "force_list"}) {
    EXPECT_EQ(drawn(pipeline, name, 1.3).action, Marker::DELETE) << name;
  }
}

TEST_F(ForceMarkers, GoWhenTheToolsStandNowhere) {
  Pipeline pipeline(block(), SolverConfig(), {sphere()});
  EXPECT_FALSE(builder_.fallBehind(pipeline)) << "nothing is drawn";
  pipeline.step(sphereAt(0.004));
  builder_.reach(pipeline, ros::Time(1.0));
  ASSERT_NE(drawn(pipeline, "force_labels", 1.0).text, "");
  pipeline.reset();
  EXPECT_TRUE(builder_.fallBehind(pipeline));
  EXPECT_EQ(drawn(pipeline, "force_labels", 1.1).action, Marker::DELETE);
}

// A blade without sides leaves the shape as it is: its force changes all the same, and is gone
// when it has left.
TEST_F(ForceMarkers, FollowABladeThatBendsNothing) {
  ToolGeometry blade;
  blade.name = "blade";
  blade.role = toolRole("blade");
  blade.blade.edge = {Vec3::Zero(), Vec3(0.0, 0.0, 0.025)};
  blade.blade.resistance = 150.0;
  blade.links.push_back({"blade", {}});
  Pipeline pipeline(block(), SolverConfig(), {blade});
  using What = MarkerBuilder::What;
  std::string number;  // as a listener has it
  int without_shape = 0;
  for (int i = 0; i <= 60; ++i) {
    RobotPose pose;
    pose.links.push_back(Pose::Identity());
    pose.links.front().translation() = Vec3(0.042, -0.01 + 0.002 * i, 0.025);
    pipeline.step(pose);
    ASSERT_TRUE(pipeline.hasArrived());
    const bool news = builder_.reach(pipeline, ros::Time(1.0 + i)).any();
    const bool shape = pipeline.report().changed;
    if (news && !shape) ++without_shape;
    if (!news && !shape) continue;
    const auto array =
        builder_.buildChanged(pipeline, ros::Time(1.0 + i), shape ? What::kAll : What::kTools);
    const Marker label = only(array, "force_labels");
    if (!label.ns.empty()) number = label.text;
    if (!shape) {
      EXPECT_EQ(only(array, "surface").ns, "") << "it is as it was";
    }
    const double force = pipeline.report().tools[0].force_on_tool.norm();
    EXPECT_NEAR(number.empty() ? 0.0 : std::stod(number), force, 0.006) << "at pose " << i;
  }
  EXPECT_GT(without_shape, 3);
  EXPECT_EQ(number, "") << "it has left";
}

}  // namespace
}  // namespace robot_tissue::test_force_markers
