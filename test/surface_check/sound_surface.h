// What is wrong with the displayed surface of cut tissue at rest, as a library sees it
// (exact_surface.h).
#pragma once

#include <string>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

double volumeOf(const Tissue& tissue);

// Empty: of every piece the surface is closed and manifold, together they enclose the volume (m^3)
// within 1e-6 of it, and no two triangles cross by more than `rounding` (m).
std::string faultOf(const Tissue& tissue, double volume, double rounding = 0.0);

}  // namespace robot_tissue
