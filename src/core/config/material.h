// Which material is where, and its moduli.
#pragma once

#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// The last region that holds the point, with a slack of a thousandth of the spacing; the tissue's
// own material elsewhere.
const Material& materialAt(const TissueConfig& config, const Vec3& point);

// Of an isotropic material.
struct Moduli {
  double shear = 0.0;       // Pa, at small strain
  double bulk = 0.0;        // Pa
  double stiffening = 0.0;  // b of Material::stiffening
};

Moduli moduliOf(const Material& material);
double poissonRatio(const Moduli& moduli);

double shearModulus(const Material& material);  // Pa
double bulkModulus(const Material& material);   // Pa

}  // namespace robot_tissue
