// Which material is where, and its moduli.
#pragma once

#include <utility>
#include <vector>

#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Whether the region's box holds the point, with a slack of a thousandth of the spacing.
bool contains(const Region& region, const Vec3& point, double spacing);

// Of an isotropic material.
struct Moduli {
  double shear = 0.0;       // Pa, at small strain
  double bulk = 0.0;        // Pa
  double stiffening = 0.0;  // b of Material::stiffening
};

Moduli moduliOf(const Material& material);
double poissonRatio(const Moduli& moduli);

// Of several materials in one cell with their shares of it, 1 in sum: the first one has the others
// in it as balls (Hashin and Shtrikman 1963; Mori and Tanaka 1973; doc/model.md).
Moduli mixed(const std::vector<std::pair<Moduli, double>>& parts);

double shearModulus(const Material& material);  // Pa
double bulkModulus(const Material& material);   // Pa

}  // namespace robot_tissue
