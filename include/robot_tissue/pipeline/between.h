// Poses on the way from one to another: straight, and turning evenly.
#pragma once

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// At that share of the way (1); at its ends, and beyond them, exactly these.
Pose between(const Pose& from, const Pose& to, double share);
// Link by link, and the stamps.
RobotPose between(const RobotPose& from, const RobotPose& to, double share);

}  // namespace robot_tissue
