// Data between stages, 1 of 4: where the tools are.
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct RobotPose {
  double stamp_s = 0.0;     // one common stamp for all tools
  std::vector<Pose> tools;  // tissue_T_tool, one per tool, in the order of the scene's tools
};

}  // namespace robot_tissue
