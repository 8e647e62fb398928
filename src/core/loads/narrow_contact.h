// The law of narrow contacts (robot_tissue/core/narrow_contact.h).
#pragma once

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/narrow_contact.h"

namespace robot_tissue {

struct SurfaceModuli {
  double shear = 0.0;  // Pa
  double poisson_ratio = 0.0;
};

// No recess under a contact that is wide.
Recess recessUnder(const BallPress& press, const Lattice& lattice, const SurfaceModuli& moduli);

}  // namespace robot_tissue
