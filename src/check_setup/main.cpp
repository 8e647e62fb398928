#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <iostream>

#include "check_setup.h"
#include "robot_checks.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/ros/robot_description.h"

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
  const ros::SteadyTime end = ros::SteadyTime::now() + kPatience;
  do {
    missing.erase(std::remove_if(missing.begin(), missing.end(), is_known), missing.end());
    if (!missing.empty()) kPause.sleep();
  } while (!missing.empty() && ros::SteadyTime::now() < end);
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

// As the node of its usual name looks for it.
robot_tissue::Robot describedRobot(const robot_tissue::NodeParameters& parameters) {
  const std::string& parameter = parameters.robot_description_param;
  const std::string remedy = "load the robot's URDF to this parameter";
  try {
    const ros::NodeHandle node("robot_tissue");
    const auto urdf = robot_tissue::robotDescription(node, parameter);
    if (urdf) {
      robot_tissue::requireUrdf(*urdf);
      return {urdf, {}};
    }
    if (!robot_tissue::linkThatNeedsUrdf(parameters.scene.tools)) return {};  // as for the node
    return {{}, {{Finding::Level::kWarning, "parameter '" + parameter + "' is not set", remedy}}};
  } catch (const robot_tissue::InputError& error) {
    return {{}, {{Finding::Level::kError, error.what(), remedy}}};
  }
}

robot_tissue::Robot lookAtMaster(const robot_tissue::NodeParameters& parameters) {
  if (!ros::master::check()) {
    return {{},
            {{Finding::Level::kNote, "no master runs: links and transforms were not looked at",
              "--urdf FILE, or start the robot first"}}};
  }
  const bool is_needed = !parameters.scene.tools.empty();
  robot_tissue::Robot robot = is_needed ? describedRobot(parameters) : robot_tissue::Robot();
  const Findings frames = checkFrames(parameters.scene);
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
