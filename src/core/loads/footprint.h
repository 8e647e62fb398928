// Where a box or a cylinder touches a half-space that it is pressed into, and how far that gives
// way (own; doc/model.md, "Narrow contacts").
#pragma once

#include "robot_tissue/core/narrow_contact.h"

namespace robot_tissue {

struct Footprint {
  double width = 0.0;  // the lesser of its sides (m)
  double depth = 0.0;  // of the shape's lowest place (m)
  double bulge = 0.0;  // how far this is not known, as it is of a flat surface (m)
};

// Of the tissue that is pressed.
struct Bulge {
  double curvature = 0.0;  // 1/m: > 0 where it bulges outwards
  double reach = 0.0;      // m: as far from what touches its surface may be what is pressed
};

// `facing`: unit, the way it presses, in the shape's frame. `force` > 0 (N), `plane_modulus` (Pa).
Footprint footprintOf(const BoxOrCylinder& body, const Vec3& facing, double force,
                      double plane_modulus, const Bulge& tissue = {});

}  // namespace robot_tissue
