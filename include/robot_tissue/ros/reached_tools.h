// What is drawn of the tools: as they were at the last pose that the tissue reached. A tissue that
// is on its way between two poses has forces of neither.
#pragma once

#include <ros/time.h>

#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

struct ReachedTools {
  // Of the tissue on a tool, in the tissue's frame.
  struct Force {
    Vec3 force = Vec3::Zero();   // N
    Vec3 place = Vec3::Zero();   // where it acts (m)
    Vec3 normal = Vec3::Zero();  // of ToolReport; zero: the tool touches nothing
    bool operator==(const Force& other) const {
      return force == other.force && place == other.place && normal == other.normal;
    }
  };

  ros::Time stamp;            // of that pose
  RobotPose pose;             // where the links were
  std::vector<Force> forces;  // a tool each; empty before the first pose
  std::vector<Vec3> edges;    // of tools that cut: two ends a piece (m, tissue frame)
};

// The pipeline has arrived at the pose with this stamp.
ReachedTools reachedTools(const Pipeline& pipeline, const ros::Time& stamp);

}  // namespace robot_tissue
