// How a surface is curved around a place (own).
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Mean curvature (1/m) of these vertices, at places (m) around the place, to some `reach` (m); > 0
// where they bulge outwards. Of the paraboloid, as curved in all directions, that fits them best:
// height = c + g t - curvature r^2 / 2. 0 of too few.
double meanCurvature(const std::vector<Vec3>& places, const std::vector<int>& vertices,
                     const Vec3& place, const Vec3& outwards, double reach);

}  // namespace robot_tissue
