// Where a box or a cylinder touches a half-space that it is pressed into, and how far that gives
// way (own; doc/model.md, "Narrow contacts").
#pragma once

#include "robot_tissue/core/narrow_contact.h"

namespace robot_tissue {

struct Footprint {
  double width = 0.0;   // the lesser of its sides (m)
  double depth = 0.0;   // how far the half-space gives way, mean over the pressure (m)
  double height = 0.0;  // of the shape there over its lowest point, likewise (m)
  double share = 1.0;   // how far this is known (1): not of corners, nor of cylinders on their rim
};

// `facing`: unit, the way it presses, in the shape's frame. `force` > 0 (N), `plane_modulus` (Pa).
Footprint footprintOf(const BoxOrCylinder& body, const Vec3& facing, double force,
                      double plane_modulus);

}  // namespace robot_tissue
