// Where to begin the search for the places of a triangle that are deepest in a mesh (own).
#pragma once

#include <vector>

#include "tool_mesh.h"
#include "triangle_bvh.h"

namespace robot_tissue {

// Weights of the corners. Of each connected part of the mesh's surface that cuts the triangle: its
// middle and two ends. Of what does not cut it but is nearer than `reach` (m): where a vertex is
// over the triangle, or an edge beside one of its edges, and every way leads apart. And the middle.
// In: corners of the triangle in the mesh's frame, with area; the faces near it.
std::vector<Vec3> seedsOn(const Corners& corners, const ToolMesh& mesh,
                          const std::vector<int>& faces, double reach);

}  // namespace robot_tissue
