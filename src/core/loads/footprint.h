// Where a shape touches a half-space that it is pressed into, and how far that gives way (own;
// doc/model.md, "Narrow contacts").
#pragma once

#include "robot_tissue/core/indenter.h"
#include "robot_tissue/core/narrow_contact.h"

namespace robot_tissue {

struct Footprint {
  double width = 0.0;   // of a strip that has its lesser second moment (m)
  double depth = 0.0;   // of the shape's lowest place (m)
  double height = 0.0;  // over that, of what touches, in the mean under its pressure (m)
  double growth = 0.0;  // of the depth, with the logarithm of the force (m)
};

// Of the tissue that is pressed.
struct Bulge {
  double curvature = 0.0;    // 1/m: > 0 where it bulges outwards
  Vec3 apex = Vec3::Zero();  // where its surface is level, as seen along the way; shape's frame (m)
};

// `load`: force over plane modulus (m^2), > 0. The part has levels.
Footprint footprintOf(const IndenterPart& part, double load, const Bulge& tissue = {});

// The load (m^2) at which it is as deep as that (m); 0 of none.
double loadAt(double depth, const IndenterPart& part, const Bulge& tissue = {});

}  // namespace robot_tissue
