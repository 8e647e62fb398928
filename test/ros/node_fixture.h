// A tissue node under a real master, with this test as its robot: it publishes the transforms of
// the tools and listens to all that the node says. Waiting is always for a condition, with a
// deadline.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <robot_tissue/ApplyLoad.h>
#include <robot_tissue/ContactArray.h>
#include <robot_tissue/Cut.h>
#include <robot_tissue/TissueState.h>
#include <robot_tissue/Tool.h>
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

  explicit NodeTest(const std::string& tool = "probe") {
    subscribers_.push_back(node_.subscribe<TissueState>("/tissue/state", 100,
                                                        [this](const TissueStateConstPtr& state) {
                                                          state_ = state;
                                                          said_[state->status] = state->message;
                                                        }));
    subscribe<geometry_msgs::WrenchStamped>(tool + "/measured_cf", wrench_);
    subscribe<ContactArray>("contacts", contacts_);
    subscribers_.push_back(node_.subscribe<visualization_msgs::MarkerArray>(
        "/tissue/markers", 10, [this](const visualization_msgs::MarkerArrayConstPtr& array) {
          for (const auto& marker : array->markers) {
            markers_[marker.id == 0 ? marker.ns : marker.ns + std::to_string(marker.id)] = marker;
          }
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

  // Spins, with the tools where they are, until the condition holds; false after the deadline.
  bool waitFor(const std::function<bool()>& condition, double deadline = kDeadline) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(deadline);
    while (ros::WallTime::now() < end) {
      if (publishes_transform_) broadcaster_.sendTransform(transforms());
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.002).sleep();
    }
    return false;
  }

  geometry_msgs::TransformStamped transform(const std::string& child, double x, double y,
                                            double z) const {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time::now();
    transform.header.frame_id = "base";
    transform.child_frame_id = child;
    transform.transform.translation.x = x;
    transform.transform.translation.y = y;
    transform.transform.translation.z = z;
    transform.transform.rotation.w = 1.0;
    return transform;
  }

  // The base stands 1 m beside the tissue; the probe's frame is turned upside down, its z down.
  virtual std::vector<geometry_msgs::TransformStamped> transforms() const {
    auto probe = transform("probe", 1.05, 0.05, kTop + kRadius - depth_);
    probe.transform.rotation.x = 1.0;
    probe.transform.rotation.w = 0.0;
    return {transform("tissue", 1.0, 0.0, 0.0), probe};
  }

  // Waits until the node has followed the tools to where they are now, and returns the wrench. On
  // the way there the wrench differs from update to update.
  geometry_msgs::WrenchStamped follow() {
    const ros::Time moved = ros::Time::now();
    boost::shared_ptr<const geometry_msgs::WrenchStamped> before;
    EXPECT_TRUE(waitFor([&] {
      if (!wrench_ || wrench_->header.stamp <= moved) return false;
      if (before && wrench_->header.stamp == before->header.stamp) return false;
      const bool stands = before && wrench_->wrench == before->wrench;
      before = wrench_;
      // A state of before the move would say nothing of it.
      return stands && state_ && state_->header.stamp > moved && state_->status != "TOO_FAST";
    })) << "the node says "
        << (state_ ? state_->status + ": " + state_->message : std::string("nothing"));
    return wrench_ ? *wrench_ : geometry_msgs::WrenchStamped();
  }

  // Moves the probe to a depth and waits until the node has followed it there.
  geometry_msgs::WrenchStamped press(double depth) {
    depth_ = depth;
    return follow();
  }

  // Waits for touches of where the tools are now: those of the way there, told while the shape had
  // yet to come to balance, may arrive after the wrench of its end.
  bool waitForContacts() {
    const ros::Time now = ros::Time::now();
    return waitFor([&] {
      return contacts_ && contacts_->header.stamp >= now && !contacts_->contacts.empty();
    });
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

  // Asks again while the node has had no time to bring the load on in full.
  ApplyLoad::Response applyLoad(const ApplyLoad::Request& request) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kDeadline);
    ApplyLoad call;
    call.request = request;
    EXPECT_TRUE(ros::service::call("/tissue/apply_load", call));
    while (isOnItsWay(call.response) && ros::WallTime::now() < end) {
      follow();  // poses go on
      EXPECT_TRUE(ros::service::call("/tissue/apply_load", call));
    }
    return call.response;
  }

  static bool isOnItsWay(const ApplyLoad::Response& response) {
    const auto says = [&](const char* text) {
      return response.message.find(text) != std::string::npos;
    };
    return response.success && (says("on its way") || says("; LATE") || says("next good pose"));
  }

  // Of a tool: ~grasp and ~release.
  static Tool::Response ask(const std::string& service, const std::string& tool) {
    Tool call;
    call.request.tool = tool;
    EXPECT_TRUE(ros::service::call("/tissue/" + service, call));
    EXPECT_EQ(call.response.message.find('\n'), std::string::npos);
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
  std::map<std::string, std::string> said_;  // status and its last message, of all states so far
  boost::shared_ptr<const geometry_msgs::WrenchStamped> wrench_;
  boost::shared_ptr<const ContactArray> contacts_;
  std::map<std::string, visualization_msgs::Marker> markers_;  // by namespace, with ids above 0
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> diagnostics_;
};

}  // namespace robot_tissue
