#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "robot_tissue/core/types.h"
#include "robot_tissue/ros/tissue_node.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/value_text.h"

namespace {

// As roscpp does on SIGINT.
void endOn(int signal) {
  const auto before = std::signal(signal, [](int) { ros::requestShutdown(); });
  if (before == SIG_IGN) std::signal(signal, SIG_IGN);  // as nohup wants it
}

// What is left of the arguments when roscpp took its remappings.
[[noreturn]] void refuseArgument(const std::string& argument) {
  throw robot_tissue::InputError(
      "'" + robot_tissue::shortText(argument) +
      "': an argument; allowed: none but remappings (name:=value), as the scene is read from the "
      "node's private parameters, which `roslaunch robot_tissue tissue.launch scene:=FILE` loads");
}

}  // namespace

int main(int argc, char** argv) {
  robot_tissue::keepFreeMemory();
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // lines of the log come at once, also to a file
  // The last handle to go closes the log, so one stays until the last line is said.
  std::optional<ros::NodeHandle> private_node;
  try {
    ros::init(argc, argv, "robot_tissue");  // throws at a name that is none
    if (argc > 1) refuseArgument(argv[1]);
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
