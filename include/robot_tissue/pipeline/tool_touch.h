// One touch of a tool: a point of the surface that it pushes, or a node that it holds.
#pragma once

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Tissue frame. What the tool exerts on the tissue there is
// normal_force * normal + friction_force; over all touches of a tool, its force.
struct ToolTouch {
  Vec3 point = Vec3::Zero();           // of the deformed tissue (m)
  Vec3 normal = Vec3::Zero();          // unit, from the tool into the tissue; zero for a held node
                                       // without a way out
  double depth_m = 0.0;                // of the point in the tool; < 0: a gap
  double normal_force = 0.0;           // N; < 0: a held node is pulled
  Vec3 friction_force = Vec3::Zero();  // across the normal (N)
};

}  // namespace robot_tissue
