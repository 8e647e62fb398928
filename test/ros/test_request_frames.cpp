// Which transforms are taken, and where a request's frame is.
#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <limits>

#include "robot_tissue/core/types.h"
#include "robot_tissue/ros/tool_poses.h"
#include "robot_tissue/ros/transform_intake.h"

namespace robot_tissue::test_request_frames {
namespace {

constexpr double kTimeout = 0.5;  // s

geometry_msgs::TransformStamped cameraAt(double x, double stamp) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "tissue";
  transform.header.stamp = ros::Time(stamp);
  transform.child_frame_id = "camera";
  transform.transform.translation.x = x;
  transform.transform.rotation.w = 1.0;
  return transform;
}

std_msgs::Header of(const std::string& frame, double stamp) {
  std_msgs::Header header;
  header.frame_id = frame;
  header.stamp = ros::Time(stamp);
  return header;
}

class RequestFrame : public ::testing::Test {
 protected:
  RequestFrame() {
    buffer_.setTransform(cameraAt(0.1, 100.0), "test");
    buffer_.setTransform(cameraAt(0.3, 101.0), "test");
  }
  double x(double stamp) const { return poses_.frame(of("camera", stamp)).translation().x(); }
  std::string refusalOf(const std::string& frame, double stamp) const {
    try {
      poses_.frame(of(frame, stamp));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  tf2::BufferCore buffer_;
  ToolPoses poses_{buffer_, "tissue", kTimeout};
};

TEST_F(RequestFrame, IsWhereItWasAtTheStamp) {
  EXPECT_NEAR(x(100.0), 0.1, 1e-12);
  EXPECT_NEAR(x(100.5), 0.2, 1e-12);
  EXPECT_NEAR(x(101.0), 0.3, 1e-12);
  EXPECT_NEAR(x(0.0), 0.3, 1e-12) << "without a stamp the newest counts";
  EXPECT_NEAR(x(101.4), 0.3, 1e-12) << "a transform comes a little later than its request";
}

// The buffer takes quaternions that are a little too long; a pose must stretch nothing.
TEST_F(RequestFrame, TurnsAndStretchesNothing) {
  geometry_msgs::TransformStamped turned = cameraAt(0.3, 102.0);
  turned.transform.rotation.x = turned.transform.rotation.w = 1.004 * std::sqrt(0.5);
  ASSERT_TRUE(buffer_.setTransform(turned, "test"));
  poses_.setLinks({"camera"});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitX()).toRotationMatrix();
  const PoseLookUp found = poses_.lookUp(ros::Time(102.0));
  ASSERT_EQ(found.pose.links.size(), 1U) << found.message;
  EXPECT_TRUE(found.pose.links.front().linear().isApprox(turn, 1e-12));
  EXPECT_TRUE(poses_.frame(of("camera", 0.0)).linear().isApprox(turn, 1e-12));
  EXPECT_TRUE(poses_.frame(of("camera", 102.0)).linear().isApprox(turn, 1e-12));
}

// Numbers of a length that one reads, and no blanks at the end.
TEST_F(RequestFrame, WhyThereIsNoPoseIsToldInShort) {
  poses_.setLinks({"camera"});
  EXPECT_EQ(poses_.lookUp(ros::Time(102.5018803)).message,
            "the pose of link 'camera' is 1.502 s old; allowed: 0.5 (~tf_timeout)");
  EXPECT_EQ(poses_.lookUp(ros::Time(101.50000001)).message,
            "the pose of link 'camera' is 0.501 s old; allowed: 0.5 (~tf_timeout)");
  poses_.setLinks({"lost"});
  const std::string lost = poses_.lookUp(ros::Time(101.0)).message;
  EXPECT_NE(lost.find("no transform from link 'lost' to 'tissue': "), std::string::npos) << lost;
  EXPECT_NE(lost.back(), ' ') << lost;
}

TEST_F(RequestFrame, OfAnotherTimeIsRefused) {
  EXPECT_NE(refusalOf("camera", 101.6).find("header.stamp: 0.6 s after the newest"),
            std::string::npos);
  EXPECT_NE(refusalOf("camera", 99.0).find("header.stamp: 'camera' has no transform of then"),
            std::string::npos);
  EXPECT_NE(refusalOf("nowhere", 101.0).find("header.frame_id: 'nowhere'"), std::string::npos);
}

TEST_F(RequestFrame, WithASlashAheadIsRefusedForThat) {
  EXPECT_NE(refusalOf("/camera", 0.0).find("header.frame_id: '/camera' begins with '/'; allowed: "),
            std::string::npos)
      << refusalOf("/camera", 0.0);
}

TEST_F(RequestFrame, ThatStandsIsThereAtAnyTime) {
  geometry_msgs::TransformStamped base = cameraAt(0.7, 50.0);
  base.child_frame_id = "base";
  buffer_.setTransform(base, "test", true);
  for (const double stamp : {0.0, 1.0, 101.0, 5000.0}) {
    EXPECT_NEAR(poses_.frame(of("base", stamp)).translation().x(), 0.7, 1e-12) << stamp;
  }
  EXPECT_TRUE(poses_.frame(of("", 5000.0)).isApprox(Pose::Identity()));
}

// A message of before is on its way as time goes back, as where a bag begins again.
TEST(TransformIntake, WhatIsAheadOfATimeThatWentBackIsLeftOut) {
  tf2::BufferCore buffer;
  bool went_back = false;
  ros::Time::init();
  TransformIntake intake(buffer, [&] { return std::exchange(went_back, false); });
  const auto take = [&](double now, double x, double stamp) {
    ros::Time::setNow(ros::Time(now));
    tf2_msgs::TFMessage message;
    message.transforms.push_back(cameraAt(x, stamp));
    intake.take(message, TransformIntake::Kind::kMoving);
    return buffer.lookupTransform("tissue", "camera", ros::Time(0)).transform.translation.x;
  };
  EXPECT_EQ(take(109.0, 0.1, 109.0), 0.1);
  buffer.clear();
  went_back = true;
  ros::Time::setNow(ros::Time(100.0));
  EXPECT_EQ(take(100.0, 0.2, 100.0), 0.2);
  EXPECT_EQ(take(100.01, 0.1, 109.0), 0.2);
  EXPECT_EQ(take(100.02, 0.3, 100.02), 0.3);
  EXPECT_EQ(take(100.03, 0.4, 100.2), 0.4) << "a simulator's next tick";
  EXPECT_EQ(take(102.0, 0.5, 103.0), 0.5) << "nothing of before comes so late";
}

TEST(TransformIntake, WhatIsNoTransformIsToldUntilAGoodOneComes) {
  tf2::BufferCore buffer;
  ros::Time::init();
  ros::Time::setNow(ros::Time(100.0));
  TransformIntake intake(buffer, [] { return false; });
  const auto refused = [&](const std::string& frame, double x, double w) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(cameraAt(x, 100.0));
    message.transforms.back().child_frame_id = frame;
    message.transforms.back().transform.rotation.w = w;
    intake.take(message, TransformIntake::Kind::kMoving);
    return intake.refused();
  };
  EXPECT_EQ(refused("camera", 0.1, 1.0), "");
  EXPECT_EQ(refused("camera", std::nan(""), 1.0),
            "the transform of 'camera' is left out, as numbers in it are not finite");
  EXPECT_NE(refused("tool", 0.1, 1.0), "") << "of another frame";
  EXPECT_EQ(refused("camera", 0.1, 1.0), "");
  EXPECT_NE(refused("camera", 0.1, 0.0).find("quaternion"), std::string::npos);
  EXPECT_NE(refused("tissue", 0.1, 1.0).find("its frame_id is the same"), std::string::npos);
}

// The buffer takes infinite numbers, and looks them up.
TEST(TransformIntake, InfiniteNumbersDoNotReachTheBuffer) {
  tf2::BufferCore buffer;
  ros::Time::init();
  ros::Time::setNow(ros::Time(100.0));
  TransformIntake intake(buffer, [] { return false; });
  for (const double x : {0.1, std::numeric_limits<double>::infinity(), std::nan("")}) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(cameraAt(x, 100.0 + (x == 0.1 ? 0.0 : 1.0)));
    intake.take(message, TransformIntake::Kind::kMoving);
  }
  const auto newest = buffer.lookupTransform("tissue", "camera", ros::Time(0));
  EXPECT_EQ(newest.transform.translation.x, 0.1);
  EXPECT_EQ(newest.header.stamp, ros::Time(100.0));
}

}  // namespace
}  // namespace robot_tissue::test_request_frames
