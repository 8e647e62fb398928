// Data between stages, 1 of 4: where the tools are.
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

constexpr double kFarAway = 1e6;  // m along x: from here on, a link stands nowhere

struct RobotPose {
  double stamp_s = 0.0;     // one common stamp for all links
  std::vector<Pose> links;  // tissue_T_link: the links of the first tool, of the second, ...
};

}  // namespace robot_tissue
