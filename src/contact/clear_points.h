// Points of a shape that are known to be outside of a surface from when it was last asked for them,
// as neither has moved far since.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "placed_link.h"

namespace robot_tissue {

class ClearPoints {
 public:
  // A look at so many points of the shape. `tree`: a number that is another one with each other
  // surface; `vertices`: that it was moved to (m).
  void beginLook(const PlacedShape& placed, std::uint64_t tree, const std::vector<Vec3>& vertices,
                 std::size_t points);
  // How far the surface went at most, as seen from the shape, since the look before (m); 0 in the
  // first one.
  double lastWay() const { return last_way_; }
  bool isClear(std::size_t point) const { return gone_ < clear_until_[point]; }
  // A point that is outside, and so far from the surface (m) at least.
  void note(std::size_t point, double clearance) { clear_until_[point] = gone_ + clearance; }

 private:
  std::uint64_t tree_ = 0;
  std::vector<Vec3> vertices_;       // of the surface in the shape's frame, at the last look (m)
  std::vector<double> clear_until_;  // per point: clear as long as `gone_` is less (m)
  double gone_ = 0.0;                // sum of the ways of all looks (m)
  double last_way_ = 0.0;
};

}  // namespace robot_tissue
