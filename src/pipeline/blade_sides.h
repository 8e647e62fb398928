// The sides of a blade.
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A point between them (m), and across them, unit; zero without sides. Link's frame.
struct BladeSides {
  Vec3 middle = Vec3::Zero();
  Vec3 across = Vec3::Zero();
};

// Of a blade with this edge, and with these points on the surface of its shapes (m).
BladeSides sidesOf(const std::vector<Vec3>& edge, const std::vector<Vec3>& points);

}  // namespace robot_tissue
