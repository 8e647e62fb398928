// A tissue node under a real master, with this test as its robot: it publishes the transform of the
// tool and listens to all that the node says. Waiting is always for a condition, with a deadline.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <robot_tissue/ApplyLoad.h>
#include <robot_tissue/ContactArray.h>
#include <robot_tissue/Cut.h>
#include <robot_tissue/TissueState.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace robot_tissue {

constexpr double kDeadline = 20.0;  // s, wall time; reached only when something is wrong
constexpr double kTop = 0.05;       // of the block (m)
constexpr double kRadius = 0.01;    // of the probe (m)

class NodeTest : public ::testing::Test {
 protected:
  using Points = std::vector<geometry_msgs::Point>;

  NodeTest() {
    subscribe<TissueState>("state", state_);
    subscribe<geometry_msgs::WrenchStamped>("probe/measured_cf", wrench_);
    subscribe<ContactArray>("contacts", contacts_);
    subscribers_.push_back(node_.subscribe<visualization_msgs::MarkerArray>(
        "/tissue/markers", 10, [this](const visualization_msgs::MarkerArrayConstPtr& array) {
          for (const auto& marker : array->markers) markers_[marker.ns] = marker;
        }));
    subscribers_.push_back(node_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
          for (const auto& status : array->status) diagnostics_[status.name] = status;
        }));
  }

  template <class Message>
  void subscribe(const std::string& topic, boost::shared_ptr<const Message>& latest) {
    subscribers_.push_back(node_.subscribe<Message>(
        "/tissue/" + topic, 10,
        [&latest](const boost::shared_ptr<const Message>& message) { latest = message; }));
  }

  // Spins, with the tool where it is, until the condition holds; false after the deadline.
  bool waitFor(const std::function<bool()>& condition, double deadline = kDeadline) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(deadline);
    while (ros::WallTime::now() < end) {
      if (publishes_transform_) sendTransform();
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.002).sleep();
    }
    return false;
  }

  // The base stands 1 m beside the tissue; the probe's frame is turned upside down, its z down.
  void sendTransform() {
    geometry_msgs::TransformStamped tissue, tool;
    tissue.header.stamp = tool.header.stamp = ros::Time::now();
    tissue.header.frame_id = tool.header.frame_id = "base";
    tissue.child_frame_id = "tissue";
    tissue.transform.translation.x = 1.0;
    tissue.transform.rotation.w = 1.0;
    tool.child_frame_id = "probe";
    tool.transform.translation.x = 1.05;
    tool.transform.translation.y = 0.05;
    tool.transform.translation.z = kTop + kRadius - depth_;
    tool.transform.rotation.x = 1.0;
    broadcaster_.sendTransform(std::vector<geometry_msgs::TransformStamped>{tissue, tool});
  }

  // Moves the probe to a depth, waits until the node has seen it there, and returns the wrench.
  geometry_msgs::WrenchStamped press(double depth) {
    depth_ = depth;
    const ros::Time moved = ros::Time::now();
    EXPECT_TRUE(waitFor([&] { return wrench_ && wrench_->header.stamp > moved; }));
    return wrench_ ? *wrench_ : geometry_msgs::WrenchStamped();
  }

  bool waitForMarkers(const std::function<bool()>& condition) {
    return waitFor([&] { return markers_.count("surface") > 0 && condition(); });
  }

  double lowestOfTop() {
    double lowest = kTop;
    for (const auto& point : markers_["surface"].points) {
      const bool in_the_middle = std::hypot(point.x - 0.05, point.y - 0.05) < 0.004;
      if (in_the_middle && point.z > 0.001) lowest = std::min(lowest, point.z);
    }
    return lowest;
  }

  Cut::Response cut(const std::vector<std::vector<double>>& corners,
                    const std::string& frame = "tissue") {
    Cut call;
    call.request.header.frame_id = frame;
    for (const auto& corner : corners) {
      geometry_msgs::Point point;
      point.x = corner[0];
      point.y = corner[1];
      point.z = corner[2];
      call.request.corners.push_back(point);
    }
    EXPECT_TRUE(ros::service::call("/tissue/cut", call));
    return call.response;
  }

  bool reset() {
    std_srvs::Trigger call;
    return ros::service::call("/tissue/reset", call) && call.response.success;
  }

  ros::NodeHandle node_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::vector<ros::Subscriber> subscribers_;
  bool publishes_transform_ = true;
  double depth_ = -0.01;
  boost::shared_ptr<const TissueState> state_;
  boost::shared_ptr<const geometry_msgs::WrenchStamped> wrench_;
  boost::shared_ptr<const ContactArray> contacts_;
  std::map<std::string, visualization_msgs::Marker> markers_;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> diagnostics_;
};

}  // namespace robot_tissue
