// A dented surface as if it had no dent (own).
#pragma once

#include <vector>

#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// The unit way inwards of the part of the surface around the point, its vertices at these places
// (m): of triangles that at rest are within `reach` (m) and look where the point's does, up to a
// sharp fold (CurvedSurface::kSharpFold). The sum of their areas is that of any surface with the
// same border, and knows no dent inside of it. Zero where that is none.
Vec3 inwardsAroundDent(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       const SurfacePoint& point, double reach);

}  // namespace robot_tissue
