// own_robot.launch: a description and joint states are all that a robot has to give.
#include <gtest/gtest.h>
#include <robot_tissue/TissueState.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>
#include <functional>
#include <string>

namespace robot_tissue::test_own_robot {
namespace {

constexpr double kDeadline = 60.0;  // s, wall time; reached only when something is wrong

sensor_msgs::JointState jointsAtZero() {
  sensor_msgs::JointState joints;
  joints.header.stamp = ros::Time::now();
  joints.name = {"yaw_joint",      "pitch_joint",     "insertion_joint", "roll_joint",
                 "jaw_left_joint", "jaw_right_joint", "blade_joint"};
  joints.position.assign(joints.name.size(), 0.0);
  return joints;
}

class OwnRobot : public ::testing::Test {
 protected:
  OwnRobot()
      : joints_(node_.advertise<sensor_msgs::JointState>("/joint_states", 10)),
        states_(node_.subscribe<robot_tissue::TissueState>(
            "/organ/state", 10,
            [this](const robot_tissue::TissueStateConstPtr& state) { status_ = state->status; })),
        listener_(transforms_) {}

  bool waitFor(const std::function<bool()>& condition) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kDeadline);
    while (!condition() && ros::WallTime::now() < end) {
      joints_.publish(jointsAtZero());
      ros::spinOnce();
      ros::WallDuration(0.02).sleep();
    }
    return condition();
  }

  ros::NodeHandle node_;
  ros::Publisher joints_;
  std::string status_;
  ros::Subscriber states_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
};

TEST_F(OwnRobot, TissueStandsWhereItWasPutAndFollowsTheRobot) {
  ASSERT_TRUE(waitFor([this] { return status_ == "OK"; })) << status_;
  ASSERT_TRUE(
      waitFor([this] { return transforms_.canTransform("base_link", "tissue", ros::Time(0)); }));
  const auto place = transforms_.lookupTransform("base_link", "tissue", ros::Time(0)).transform;
  EXPECT_NEAR(place.translation.x, 0.2, 1e-9);
  EXPECT_NEAR(place.translation.y, -0.1, 1e-9);
  EXPECT_NEAR(place.translation.z, 0.05, 1e-9);
  EXPECT_NEAR(2.0 * std::atan2(place.rotation.z, place.rotation.w), 1.5, 1e-9);  // yaw
}

}  // namespace
}  // namespace robot_tissue::test_own_robot
