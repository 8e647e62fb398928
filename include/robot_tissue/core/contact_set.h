// Data between stages, 2 of 4: where the tools touch the deformed surface.
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A point of the surface that is inside a tool, or touches it.
struct Contact {
  int tool = 0;                     // index into RobotPose::tools
  int triangle = 0;                 // index into Surface::triangles
  Vec3 barycentric = Vec3::Zero();  // of the point in that triangle, sums to 1
  Vec3 point = Vec3::Zero();        // tissue frame, m
  Vec3 normal = Vec3::Zero();       // unit, from the tool into the tissue: the way out of the tool
  double depth_m = 0.0;             // penetration depth along the normal; <= 0: touches only
};

struct ContactSet {
  std::vector<Contact> contacts;
};

}  // namespace robot_tissue
