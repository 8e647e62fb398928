// Beside a running demo: waits until a jaw feels the tissue, then resets it by the node's service.
#include <geometry_msgs/WrenchStamped.h>
#include <robot_tissue/ContactArray.h>
#include <robot_tissue/TissueState.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <cstdio>
#include <string>

namespace {

constexpr double kDeadline = 60.0;  // s, wall time; reached only when something is wrong

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "follow_demo");
  ros::NodeHandle node;
  std::string status = "none";
  bool touches = false;
  const ros::Subscriber of_state = node.subscribe<robot_tissue::TissueState>(
      "/robot_tissue/state", 10,
      [&](const robot_tissue::TissueStateConstPtr& state) { status = state->status; });
  const ros::Subscriber of_contacts = node.subscribe<robot_tissue::ContactArray>(
      "/robot_tissue/contacts", 10, [&](const robot_tissue::ContactArrayConstPtr& array) {
        for (const robot_tissue::TissueContact& contact : array->contacts) {
          touches = touches || !contact.nodes.empty();
        }
      });
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kDeadline);
  while (ros::ok() && ros::WallTime::now() < end && !(touches && status == "OK")) {
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  std_srvs::Trigger reset;
  const bool is_reset = ros::service::call("/robot_tissue/reset", reset) && reset.response.success;
  std::printf("state %s, touches %d, reset %d\n", status.c_str(), touches, is_reset);
  return touches && status == "OK" && is_reset ? 0 : 1;
}
