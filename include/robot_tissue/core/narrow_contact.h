// A ball whose contact is narrower than the lattice tells apart (own).
//
// Under the force of one touch, or of a few, the surface has a dent of about a spacing, however
// small the ball: what a light touch feels would hang on where it is between the nodes. Where the
// tissue has a flat surface, how far it gives way under these forces is known without and with the
// lattice:
//
//   d = a^2 / R,   a^3 = 3 F R / (4 E*),   E* = 2 mu / (1 - nu)     Hertz (1882), of a half-space
//   c = sum over the nodes of w_a w_b C_ab F + z
//
// with the radius R, the force F, its shares w at the nodes, C_ab how far the lattice's node a
// goes when a unit of force is at b (point_loads.h) and z the mean height of what touches over the
// ball's lowest point, the way as the force. What is farther off, as the ground, the lattice tells
// right. So the ball touches as if its surface were d - c inside it.
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct Ball {
  Vec3 center = Vec3::Zero();  // m
  double radius = 0.0;         // m
};

struct BallPress {
  double radius = 0.0;             // R (m)
  double force = 0.0;              // F (N); 0: that of `depth`
  double depth = 0.0;              // d (m)
  std::vector<NodeWeight> shares;  // w, sum to 1
  double height = 0.0;             // z (m)
};

struct Recess {
  double depth = 0.0;  // d - c (m); < 0: it reaches out
  // By so much (1) of the way to `depth` the force goes to where it hangs together with that: a
  // recess changes the force, and that the depth (Newton's step).
  double step = 1.0;
};

}  // namespace robot_tissue
