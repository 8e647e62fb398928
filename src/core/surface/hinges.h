// Where material meets along a line, or at a point, alone (own).
#pragma once

#include <vector>

#include "robot_tissue/core/surface.h"
#include "surface/octant_grid.h"

namespace robot_tissue {

// Edges that more than two triangles run along, as where removed cells leave a hinge or two cuts
// end at one line, get vertices of their own for each wedge of material, so that two triangles run
// along every edge; likewise a vertex where wedges meet at a point. `owners`: per triangle, an
// octant behind it. `places`: per vertex, where in the half grid it belongs, in half spacings;
// where a blade parted cells it stands beside that. Returns, per triangle, which one it was or was
// part of.
std::vector<int> separateHinges(const OctantGrid& octants, std::vector<Octant> owners,
                                std::vector<Vec3> places, TissueSurface& surface);

}  // namespace robot_tissue
