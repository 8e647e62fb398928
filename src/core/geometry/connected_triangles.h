// Which triangles hang together.
#pragma once

#include <cstddef>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// Of these triangles, which are numbers in `triangles`, those that hang together over their
// corners, as lists, each in their order; the lists in that of their first ones. `vertices`: how
// many the corners are of.
std::vector<std::vector<int>> connectedTriangles(const std::vector<MeshTriangle>& triangles,
                                                 const std::vector<int>& among,
                                                 std::size_t vertices);

}  // namespace robot_tissue
