// The edges along which a sheet bends, and how far what lies beside them reaches (own).
//
// A triangle of next to no width turns steeply with next to no motion of its corners: the angle at
// its long edges tells nothing of how the sheet bends, and would make it as stiff as the triangle
// is thin. Cuts leave such triangles along their edges. So a thin triangle bends as one part with
// its neighbor across its longest edge, as if the two had been divided otherwise; where the part is
// thin still, it takes the next one. Between two parts the sheet bends along the edges that they
// share, and each reaches from there to its farthest corner.
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// The corners of hinges as Hinge has them, by their edges. `rest`: of the vertices (m); `sheet`:
// triangles that have an area.
std::vector<std::array<int, 4>> bendingEdges(const std::vector<Vec3>& rest,
                                             const std::vector<MeshTriangle>& sheet);

}  // namespace robot_tissue
