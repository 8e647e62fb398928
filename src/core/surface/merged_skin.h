// Skin without the pieces that no wound asks for (own).
//
// A mesh that is cut at the planes of the half grid has vertices where these cross its triangles
// and its edges. Those that no wound has go, one after the other, and the triangles around one
// become as few as fill their outline: on both sides of the mesh's edge where it was on one. What
// is left are the mesh's own triangles, and beside wounds parts of them that are not thinner than
// they must be: thin ones turn steeply with next to no motion, which membranes cannot bear.
#pragma once

#include <vector>

#include "robot_tissue/core/surface.h"

namespace robot_tissue {

// `mesh_triangles`: per triangle, the mesh's that it is part of, -1: a cut opened it.
// `is_of_mesh`: per vertex, not 0: it stays. Two triangles run along every edge, before and after.
TissueSurface mergedSkin(const TissueSurface& surface, const std::vector<int>& mesh_triangles,
                         const std::vector<char>& is_of_mesh);

}  // namespace robot_tissue
