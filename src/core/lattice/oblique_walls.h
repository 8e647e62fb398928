// Walls oblique to the grid (own; doc/model.md, "Walls oblique to the grid").
//
// A trilinear cell has dx/dx_a at one place along axis a, that of its middle. At an oblique surface
// what is in a cell so answers as if it were further out than it is, and a wall is too stiff in
// bending. Moduli are moved inwards, as the weights of a moment-fitted quadrature are: of a cell's,
// so much goes to those beside it along each axis that the mean place and the mean square of the
// place are those of the material. Volume and mass stay where they are.
//
// `facing`, of a cell: n_y^2 n_z^2, n_z^2 n_x^2, n_x^2 n_y^2 of the surface's normal n in it.
#pragma once

#include <vector>

#include "robot_tissue/core/composition.h"
#include "robot_tissue/core/filled_grid.h"

namespace robot_tissue {

// Of each cell that holds tissue, in their order: what its share of the moduli is multiplied by.
// Nothing where that is 1 everywhere. Nothing is moved between cells of different materials.
std::vector<double> moduliFactors(const FilledGrid& tissue, const CellCompositions& compositions);

// CellFill::strain_places. What is moved is right for bending along the direction that needs the
// most; along the others the strain is taken further in.
Vec3 strainPlaces(const Vec3& facing);

}  // namespace robot_tissue
