// Every scene of config/ runs in the node, also those with steps and with meshes beside them.
#include <gtest/gtest.h>
#include <robot_tissue/TissueState.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace robot_tissue::test_scenes {
namespace {

namespace fs = std::filesystem;

constexpr double kDeadline = 60.0;  // s, wall time; reached only when something is wrong

// Names of the files of config/ that say what a tissue is.
std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(ROBOT_TISSUE_SOURCE_DIR "/config")) {
    if (file.path().extension() != ".yaml") continue;
    std::ifstream text(file.path());
    bool is_scene = false;
    for (std::string line; std::getline(text, line);) is_scene = is_scene || line == "tissue:";
    if (is_scene) names.push_back(file.path().stem().string());
  }
  return names;
}

// The links of all tools, well above the tissue.
std::vector<geometry_msgs::TransformStamped> transforms() {
  std::vector<geometry_msgs::TransformStamped> all;
  for (const char* link :
       {"jaw_left", "jaw_right", "blade", "tool_tip", "sphere", "probe", "forceps", "left_jaw",
        "right_jaw", "knife", "scissors", "left_blade", "right_blade"}) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time::now();
    transform.header.frame_id = "tissue";
    transform.child_frame_id = link;
    transform.transform.translation.z = 1.0;
    transform.transform.rotation.w = 1.0;
    all.push_back(transform);
  }
  return all;
}

TEST(Scenes, OfConfigAllRunInTheNode) {
  ros::NodeHandle node;
  const std::vector<std::string> names = sceneNames();
  ASSERT_GE(names.size(), 5U);
  std::map<std::string, std::string> status;
  std::vector<ros::Subscriber> subscribers;
  for (const std::string& name : names) {
    subscribers.push_back(node.subscribe<robot_tissue::TissueState>(
        "/" + name + "/state", 10, [&status, name](const robot_tissue::TissueStateConstPtr& state) {
          status[name] = state->status;
        }));
  }
  const auto all_ok = [&] {
    for (const std::string& name : names) {
      if (status[name] != "OK") return false;
    }
    return true;
  };
  tf2_ros::TransformBroadcaster broadcaster;
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kDeadline);
  while (!all_ok() && ros::WallTime::now() < end) {
    broadcaster.sendTransform(transforms());
    ros::spinOnce();
    ros::WallDuration(0.02).sleep();
  }
  for (const std::string& name : names) EXPECT_EQ(status[name], "OK") << name;
}

}  // namespace
}  // namespace robot_tissue::test_scenes
