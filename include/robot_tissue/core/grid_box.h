// A box of grid points.
#pragma once

#include <algorithm>
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

// All points of a grid of that size.
inline GridBox wholeOf(const std::array<int, 3>& size) {
  return {{0, 0, 0}, {size[0] - 1, size[1] - 1, size[2] - 1}};
}

// The least box that holds both.
inline GridBox joined(const GridBox& a, const GridBox& b) {
  if (a.isEmpty() || b.isEmpty()) return a.isEmpty() ? b : a;
  GridBox both;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    both.low[axis] = std::min(a.low[axis], b.low[axis]);
    both.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return both;
}

}  // namespace robot_tissue
