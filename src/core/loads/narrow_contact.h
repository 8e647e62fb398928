// The law of narrow contacts (robot_tissue/core/narrow_contact.h).
#pragma once

#include "robot_tissue/core/narrow_contact.h"

namespace robot_tissue {

struct SurfaceModuli {
  double shear = 0.0;  // Pa
  double poisson_ratio = 0.0;
};

// What is pressed.
struct PressedSurface {
  double spacing = 0.0;  // of the lattice (m)
  SurfaceModuli moduli;
  double curvature = 0.0;   // K (1/m): > 0 where it bulges outwards
  double compliance = 0.0;  // C (m/N)
};

// Whether there may be a recess; C is not asked.
bool isNarrow(const NarrowPress& press, const PressedSurface& surface);

// No recess under a contact that is wide.
Recess recessUnder(const NarrowPress& press, const PressedSurface& surface);

}  // namespace robot_tissue
