#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>

#include "robot_tissue/ros/tissue_node.h"
#include "robot_tissue/scene/memory.h"

int main(int argc, char** argv) {
  robot_tissue::keepFreeMemory();
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // lines of the log come at once, also to a file
  // The last handle to go closes the log, so one stays until the last line is said.
  std::optional<ros::NodeHandle> private_node;
  try {
    ros::init(argc, argv, "robot_tissue");                      // throws at a name that is none
    std::signal(SIGTERM, [](int) { ros::requestShutdown(); });  // as roscpp does on SIGINT
    private_node.emplace("~");
    const robot_tissue::TissueNode node(*private_node);
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
  return 0;
}
