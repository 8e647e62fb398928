#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <iostream>

#include "check_setup.h"
#include "robot_checks.h"

namespace {

using robot_tissue::Finding;
using robot_tissue::Findings;

const ros::WallDuration kPatience(3.0);  // for transforms
const ros::WallDuration kPause(0.05);

Findings checkFrames(const robot_tissue::Scene& scene) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  std::vector<std::string> missing = framesOf(scene);
  const std::string& tissue = scene.tissue.frame_id;
  const auto is_known = [&](const std::string& frame) {
    return buffer.canTransform(tissue, frame, ros::Time(0));
  };
  const ros::WallTime end = ros::WallTime::now() + kPatience;
  do {
    missing.erase(std::remove_if(missing.begin(), missing.end(), is_known), missing.end());
    if (!missing.empty()) kPause.sleep();
  } while (!missing.empty() && ros::WallTime::now() < end);
  Findings findings;
  for (const std::string& frame : missing) {
    const bool has_tissue = buffer._frameExists(tissue);
    const std::string& lacking = has_tissue ? frame : tissue;
    findings.push_back({Finding::Level::kWarning,
                        "/tf: no transform from '" + frame + "' to '" + tissue + "': '" + lacking +
                            "' is not joined to the rest",
                        has_tissue ? "a robot_state_publisher that tells it"
                                   : "a static_transform_publisher from the robot's base to it"});
  }
  return findings;
}

robot_tissue::Robot lookAtMaster(const robot_tissue::Scene& scene) {
  if (!ros::master::check()) {
    return {{},
            {{Finding::Level::kNote, "no master runs: links and transforms were not looked at",
              "--urdf FILE, or start the robot first"}}};
  }
  ros::NodeHandle node;
  robot_tissue::Robot robot;
  std::string urdf;
  if (node.getParam("robot_description", urdf)) {
    robot.urdf = urdf;
  } else if (!scene.tools.empty()) {
    robot.findings.push_back({Finding::Level::kWarning, "robot_description: is not set",
                              "load the robot's URDF to this parameter"});
  }
  const Findings frames = checkFrames(scene);
  robot.findings.insert(robot.findings.end(), frames.begin(), frames.end());
  return robot;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "check_setup",
            ros::init_options::AnonymousName | ros::init_options::NoRosout);
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  return robot_tissue::checkSetup(arguments, lookAtMaster, std::cout, std::cerr);
}
