#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>

#include "robot_tissue/ros/tissue_node.h"
#include "robot_tissue/scene/memory.h"

namespace {

// As roscpp does on SIGINT.
void endOn(int signal) {
  const auto before = std::signal(signal, [](int) { ros::requestShutdown(); });
  if (before == SIG_IGN) std::signal(signal, SIG_IGN);  // as nohup wants it
}

}  // namespace

int main(int argc, char** argv) {
  robot_tissue::keepFreeMemory();
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // lines of the log come at once, also to a file
  // The last handle to go closes the log, so one stays until the last line is said.
  std::optional<ros::NodeHandle> private_node;
  try {
    ros::init(argc, argv, "robot_tissue");  // throws at a name that is none
    endOn(SIGTERM);
    endOn(SIGHUP);              // its terminal closed
    private_node.emplace("~");  // waits for the master
    if (ros::isShuttingDown()) return 0;
    const robot_tissue::TissueNode node(*private_node);
    ros::spin();
  } catch (const std::exception& error) {
    if (ros::isShuttingDown()) return 0;  // what it could not read any more is no fault
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
  return 0;
}
