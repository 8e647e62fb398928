// The box around points, of which numbers that are none do not count. Written without branches: it
// is asked for all of a surface at each look.
#pragma once

#include <array>
#include <limits>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class BoundsOfNumbers {
 public:
  void add(const Vec3& point) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double here = point[static_cast<int>(k)];
      low_[k] = here < low_[k] ? here : low_[k];
      high_[k] = here > high_[k] ? here : high_[k];
    }
  }
  // Empty (min > max) without points.
  Box box() const { return {Vec3(low_[0], low_[1], low_[2]), Vec3(high_[0], high_[1], high_[2])}; }

 private:
  static constexpr double kMost = std::numeric_limits<double>::max();
  std::array<double, 3> low_ = {kMost, kMost, kMost}, high_ = {-kMost, -kMost, -kMost};
};

}  // namespace robot_tissue
