// Poses of the links that count as one: a motion that small is none. A plain value, for any thread.
#pragma once

#include <utility>
#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Longest way (m) that a point within `reach` (m) of the link's origin goes between two poses, at
// most.
double longestWay(const Pose& from, const Pose& to, double reach);
// Likewise of the points between these (m, link frame), on the way of `between`. Much less where
// the link turns about an axis that is nearer to them than its origin, as an instrument about its
// shaft. Of no points: the way of the origin.
double longestWay(const Pose& from, const Pose& to, const std::vector<Vec3>& corners);

class StillPose {
 public:
  // reach: of each link (m); most: the longest way that is none (m).
  StillPose(RobotPose pose, std::vector<double> reach, double most)
      : pose_(std::move(pose)), reach_(std::move(reach)), most_(most) {}

  // False, too, for another number of links or a pose that is not finite.
  bool holds(const RobotPose& pose) const;

 private:
  RobotPose pose_;
  std::vector<double> reach_;
  double most_ = 0.0;
};

}  // namespace robot_tissue
