// A suture's thread on the lattice: what carries its ends, and the spring that it is to a solve.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/suture.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct SutureThread {
  // A point of the tissue's rest surface, or, with a bite, what is around it.
  struct End {
    Vec3 rest = Vec3::Zero();          // where it is at rest (m)
    Vec3 inside = Vec3::Zero();        // a place in the tissue beside it, which tells the sides of
                                       // a cut apart where both are at that place (m)
    std::vector<NodeWeight> carriers;  // weights sum to 1
    Vec3 to_middle = Vec3::Zero();     // from `rest` to the middle of what it holds, where the
                                       // thread pulls: so it turns nothing (m)
  };

  std::string name;
  End from, to;
  double rest_length = 0.0;    // m
  double stiffness = 0.0;      // N/m
  double break_force = 0.0;    // N; 0: never
  double bite = 0.0;           // m; 0: its ends are points
  double length = 0.0;         // in the place of rest_length while it is drawn in to that (m)
  double softness = 0.0;       // m/N, beside 1 / stiffness: likewise
  Vec3 offset = Vec3::Zero();  // of its way: likewise, as its own stiffness would make it (m)
  bool broken = false;
};

ContactSpring springOf(const SutureThread& thread);

// Deformed place of an end (m).
Vec3 placeOf(const SutureThread::End& end, const std::vector<Vec3>& displacement);

// Its tension is 0 when it is broken.
SutureReport reportOf(const SutureThread& thread, const std::vector<Vec3>& displacement);

}  // namespace robot_tissue
