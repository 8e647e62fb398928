// Whether a mesh encloses tissue: closed, of one orientation, not crossing itself (own).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// Why a welded mesh has no inside, as the end of a line that begins with its name ("is not closed:
// 3 of ..."); nothing when it has one. Triangles may all face inwards.
std::optional<std::string> meshFault(const TriangleMesh& mesh);

// Pairs of triangles that meet elsewhere than in the corners they share, also where they only
// touch. Decided without rounding for vertices moved to the nearest point of a grid of 2^-40 of the
// largest extent. Triangles without area count as meeting none.
std::vector<std::pair<int, int>> intersectingTriangles(const TriangleMesh& mesh);

// Turns the shells of a mesh without fault that face the wrong way: outer ones outwards, the walls
// of cavities into the cavity.
TriangleMesh facingOutward(TriangleMesh mesh);

}  // namespace robot_tissue
