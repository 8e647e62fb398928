// A tool whose contact is narrower than the lattice tells apart (own).
//
// Under the force of one touch, or of a few, the surface has a dent of about a spacing, however
// small the tool: what a light touch feels would hang on where it is between the nodes. How far the
// tissue gives way under these forces is known without and with the lattice:
//
//   d = the least of F C_s / E* + z_s + K q_s / 2 over the tool's punch levels s (indenter.h,
//       loads/footprint.h), E* = 2 mu / (1 - nu); of a ball Hertz's (1882)
//   c = C F + z + K r^2 / 2
//
// with the tissue's mean curvature K at rest, the force F, the compliance C of the lattice for
// forces that share F at its nodes (local_lattice.h), z the mean height of what touches over the
// tool's lowest point, the way as the force, and r how far off the middle of the force it touches.
// What is farther off, as the ground, the lattice tells right. So the tool touches as if its
// surface were d - c inside it.
#pragma once

#include <memory>
#include <vector>

#include "robot_tissue/core/indenter.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Spacings: there is none from a dent of that on. Chosen.
constexpr double kNoRecessFrom = 1.2;

struct NarrowPress {
  std::shared_ptr<const IndenterPart> part;
  Vec3 apex = Vec3::Zero();        // in its frame: the middle of its force (m)
  double force = 0.0;              // F (N); 0: that of `depth`
  double depth = 0.0;              // d (m)
  std::vector<NodeWeight> shares;  // w, sum to 1
  double height = 0.0;             // z (m)
  double off_apex = 0.0;           // mean of r^2 (m^2)
  SurfacePoint place;              // on the tissue, of what presses hardest
  Vec3 middle = Vec3::Zero();      // of what presses, at rest (m)
  Vec3 axis = Vec3::Zero();        // unit: the way it presses, into the tissue
};

struct Recess {
  double depth = 0.0;  // d - c (m); < 0: it reaches out
  // By so much (1) of the way to `depth` the force goes to where it hangs together with that: a
  // recess changes the force, and that the depth (Newton's step).
  double step = 1.0;
};

}  // namespace robot_tissue
