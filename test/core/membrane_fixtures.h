// Balls inside membranes, for tests and benchmarks.
#pragma once

#include <cmath>

#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

inline MembraneConfig skin(double thickness, double young_modulus, double poisson_ratio = 0.45) {
  MembraneConfig membrane;
  membrane.thickness = thickness;
  membrane.young_modulus = young_modulus;
  membrane.poisson_ratio = poisson_ratio;
  return membrane;
}

// Of a sphere with the volume that the surface encloses (m).
inline double radiusOf(const Tissue& tissue) {
  return std::cbrt(3.0 / (4.0 * M_PI) * enclosedVolume(tissue.surface(), tissue.vertices()));
}

}  // namespace robot_tissue
