// A box of grid points.
#pragma once

#include <array>
#include <cstddef>

namespace robot_tissue {

// Points from low to high, both included; none where low is above high.
struct GridBox {
  std::array<int, 3> low{};
  std::array<int, 3> high{};

  bool has(const std::array<int, 3>& place) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] < low[axis] || place[axis] > high[axis]) return false;
    }
    return true;
  }
  bool isEmpty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
  bool operator==(const GridBox& other) const { return low == other.low && high == other.high; }
  bool operator!=(const GridBox& other) const { return !(*this == other); }
};

}  // namespace robot_tissue
