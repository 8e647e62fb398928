// A ball, a box or a cylinder whose contact is narrower than the lattice tells apart (own).
//
// Under the force of one touch, or of a few, the surface has a dent of about a spacing, however
// small the ball: what a light touch feels would hang on where it is between the nodes. How far the
// tissue gives way under these forces is known without and with the lattice:
//
//   d = a^2 / R*,   a^3 = 3 F R* / (4 E*),   E* = 2 mu / (1 - nu)     Hertz (1882), of a half-space
//   c = C F + z R / R*,   1 / R* = 1 / R + K
//
// with the ball's radius R, the tissue's mean curvature K at rest, the force F, the compliance C of
// the lattice for forces that share F at its nodes (local_lattice.h) and z the mean height of what
// touches over the ball's lowest point, the way as the force. What is farther off, as the ground,
// the lattice tells right. So the ball touches as if its surface were d - c inside it.
// Of boxes and cylinders, on their faces, ends and sides, d is that of a rectangle or a lying
// cylinder (loads/footprint.h).
#pragma once

#include <optional>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct Ball {
  Vec3 center = Vec3::Zero();  // m
  double radius = 0.0;         // m
};

// Of a link; a cylinder is along its z.
struct BoxOrCylinder {
  int shape = 0;  // number in its link
  Pose link_T_shape = Pose::Identity();
  Vec3 half_size = Vec3::Zero();  // m
  double radius = 0.0;            // of a cylinder (m); 0: a box
};

struct NarrowPress {
  double radius = 0.0;                // R of a ball (m); 0: `body` presses
  std::optional<BoxOrCylinder> body;  // its depth without a force is not known
  double force = 0.0;                 // F (N); 0: that of `depth`
  double depth = 0.0;                 // d (m)
  std::vector<NodeWeight> shares;     // w, sum to 1
  double height = 0.0;                // z (m)
  Vec3 axis = Vec3::Zero();           // unit: the way it presses, into the tissue
  Vec3 facing = Vec3::Zero();         // the same in the frame of `body`
};

struct Recess {
  double depth = 0.0;  // d - c (m); < 0: it reaches out
  // By so much (1) of the way to `depth` the force goes to where it hangs together with that: a
  // recess changes the force, and that the depth (Newton's step).
  double step = 1.0;
};

}  // namespace robot_tissue
