// How far nodes of the lattice's flat surface go under a force on one of them, normal to it, in
// model `elastic` (own; doc/model.md, "Narrow contacts"): what a half-space does but near the
// force, where the lattice is another.
#pragma once

namespace robot_tissue {

// Of a node that is the root of `squared` spacings away from the force: its way along it, in force
// over shear modulus and spacing. From measured tables near the force (doc/data/point_loads.csv),
// linear between ratios, as at the nearest one outside 0.25 to 0.49; farther off Boussinesq (1885):
// (1 - nu) / (2 pi mu r).
double pointCompliance(double poisson_ratio, double squared);

}  // namespace robot_tissue
