// A patch on its way to a load, in increments from where it is.
#pragma once

#include <cstddef>

#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

struct LoadRamp {
  std::size_t patch = 0;  // number among the standing ones
  LoadingPatch start;     // of the target's nodes and drive
  LoadingPatch target;
};

// How many equal increments of at most one step a way of so many steps is; one at least.
int wholeParts(double steps);

}  // namespace robot_tissue
