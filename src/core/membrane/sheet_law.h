// What a membrane's material and thickness make of its triangles and hinges.
#pragma once

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Of a sheet of thickness t, Young's modulus E and Poisson's ratio nu.
struct SheetLaw {
  double shear = 0.0;     // mu t, mu = E / (2 (1 + nu)) (N/m)
  double exponent = 0.0;  // s = nu / (1 - nu): thickness goes by det C^(-s / 2)
  double bending = 0.0;   // D = E t^3 / (12 (1 - nu^2)) (N m)
};

SheetLaw sheetLaw(const MembraneConfig& membrane);

}  // namespace robot_tissue
