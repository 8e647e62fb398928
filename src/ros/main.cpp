#include <ros/ros.h>

#include <exception>

#include "robot_tissue/ros/tissue_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "robot_tissue");
  try {
    const robot_tissue::TissueNode node(ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 2;
  }
  return 0;
}
