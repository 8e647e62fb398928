// The displayed surface as CGAL sees it: a check by code that is not this package's.
//
// Sides along a cut lie on each other at rest, which is no fault. A crossing is a pair of triangles
// each of which has corners strictly on both sides of the other's plane, and that have a segment in
// common; signs and segment are exact.
#pragma once

#include <vector>

#include "robot_tissue/core/surface.h"

namespace robot_tissue {

// Whether the triangles with these corners make a closed, oriented surface without an edge of more
// than two triangles or a vertex where two sheets meet.
bool isClosedAndManifold(const std::vector<Vec3>& vertices,
                         const std::vector<MeshTriangle>& triangles);

double volumeInside(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles);

// Pairs of triangles that cross, and how far at most each of two has corners on both sides of the
// other's plane (m; not exact).
struct Crossings {
  int pairs = 0;
  double depth = 0.0;
};
Crossings crossingsOf(const std::vector<Vec3>& vertices,
                      const std::vector<MeshTriangle>& triangles);

}  // namespace robot_tissue
