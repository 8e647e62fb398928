// Data between stages, 2 of 4: where the tools touch the deformed surface.
#pragma once

#include <algorithm>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A point of the surface that is inside a tool, or near it: the one form of what was found. What
// is kept of it from solve to solve has it as a part (SlidingContacts::ContactConstraint).
struct Contact {
  int tool = 0;  // index into the scene's tools
  int link = 0;  // index into RobotPose::links
  SurfacePoint place;
  Vec3 point = Vec3::Zero();   // where that is now; tissue frame, m
  Vec3 normal = Vec3::Zero();  // unit, from the tool into the tissue: the way out of the tool
  double depth_m = 0.0;        // penetration depth along the normal; < 0: a gap
};

struct ContactSet {
  std::vector<Contact> contacts;
};

// Of the deepest of them (m); 0 when none is inside a tool.
inline double deepest(const ContactSet& contacts) {
  double depth = 0.0;
  for (const Contact& contact : contacts.contacts) depth = std::max(depth, contact.depth_m);
  return depth;
}

}  // namespace robot_tissue
