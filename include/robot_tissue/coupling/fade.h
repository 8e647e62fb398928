// What comes and goes evenly between two values.
#pragma once

#include <algorithm>

namespace robot_tissue {

// 1 where the value is `full` or beyond, seen from `none`, where it is 0.
inline double fade(double value, double none, double full) {
  return std::min(1.0, std::max(0.0, (value - none) / (full - none)));
}

}  // namespace robot_tissue
