// Exact integrals over tetrahedra, whole or clipped by a plane.
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

using Tetrahedron = std::array<Vec3, 4>;  // corners, whichever way it is turned

// Points x with normal . x <= offset.
struct HalfSpace {
  Vec3 normal = Vec3::UnitX();
  double offset = 0.0;
};

FillIntegrals integralsOver(const Tetrahedron& solid);
// Over what of it is in all of the half spaces.
FillIntegrals integralsWithin(const std::vector<HalfSpace>& halves, const Tetrahedron& solid);

}  // namespace robot_tissue
