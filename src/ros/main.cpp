#include <ros/ros.h>

#include <csignal>
#include <exception>

#include "robot_tissue/ros/tissue_node.h"
#include "robot_tissue/scene/memory.h"

int main(int argc, char** argv) {
  robot_tissue::keepFreeMemory();
  ros::init(argc, argv, "robot_tissue");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });  // as roscpp does on SIGINT
  // The last handle to go closes the log, so one stays until the last line is said.
  const ros::NodeHandle private_node("~");
  try {
    const robot_tissue::TissueNode node(private_node);
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
  return 0;
}
