// The way of a tool that parts tissue, in strides of a fixed length, counted from where it came in:
// so it acts at the same places whether its way is told in one pose or in a hundred.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "world.h"

namespace robot_tissue {

// Of one tool.
struct Strides {
  std::vector<Pose> stands;  // tissue_T_link of the links that are followed; empty: nowhere
  double way = 0.0;          // since the end of the last stride (m)
};

// What a tool does on its way.
struct StrideActions {
  double length = 0.0;                                 // of a stride (m)
  std::function<void()> forget;                        // it stands nowhere, or comes in anew
  std::function<void(const std::vector<Pose>&)> move;  // from where it stands, straight
  std::function<void()> act;                           // at the end of a stride
};

// The tool goes to its place in the pose from where it was last; it acts nowhere on a trial, as
// that could not be undone, nor on the way of a tool that comes from nowhere, or jumped. False:
// there was no time for all of the way; the pose has where it came to.
bool goInStrides(World& world, std::size_t tool, Links links, const StrideActions& actions,
                 Strides& strides, RobotPose& pose);

}  // namespace robot_tissue
