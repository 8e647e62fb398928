// Where a mesh is round as a ball is: fingertips, ends of probes, balls themselves (own).
#pragma once

#include <vector>

#include "robot_tissue/core/narrow_contact.h"
#include "tool_mesh.h"

namespace robot_tissue {

// Balls that parts of the mesh lie on, in its frame, in the order of their first vertex. A part is
// grown around a vertex as long as vertices, middles of edges and normals are those of the ball
// that fits its vertices best; it counts where its normals turn far enough from their mean.
std::vector<Ball> roundTips(const ToolMesh& mesh);

}  // namespace robot_tissue
