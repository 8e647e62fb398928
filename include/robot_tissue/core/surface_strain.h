// How far a surface is stretched.
#pragma once

#include <vector>

#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Per vertex of the surface: its greatest principal stretch with its vertices there (m, one for
// each of the surface's; the lengths compared with are those at rest) less 1, dimensionless. The
// mean of the triangles around, by their areas at rest; 0 where these have no area.
std::vector<double> surfaceStrains(const TissueSurface& surface, const std::vector<Vec3>& vertices);

}  // namespace robot_tissue
