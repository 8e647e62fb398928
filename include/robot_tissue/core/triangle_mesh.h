// A surface as plain triangles, and operations on it that need no lattice (own).
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

using MeshTriangle = std::array<int, 3>;

struct TriangleMesh {
  std::vector<Vec3> vertices;           // tissue frame (m)
  std::vector<MeshTriangle> triangles;  // counter-clockwise seen from outside
};

// Smallest box that holds the vertices, of which there must be one at least.
Box boundsOf(const std::vector<Vec3>& vertices);

// Twice the triangle's area, along its normal outwards (m^2).
Vec3 doubleArea(const std::vector<Vec3>& vertices, const MeshTriangle& corners);

// Volume inside closed triangles (m^3), by the divergence theorem; negative when they face inwards.
double enclosedVolume(const std::vector<Vec3>& vertices,
                      const std::vector<MeshTriangle>& triangles);

// Whether the closed triangles go around the point, by their solid angles (Van Oosterom, Strackee
// 1983).
bool encloses(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
              const Vec3& point);

// Joins vertices nearer to each other than a millionth of the mesh's largest extent (STL repeats
// them for each triangle), and leaves out the triangles that collapse and the vertices of none.
// All vertices must be finite.
TriangleMesh welded(const TriangleMesh& mesh);

// The same surface with no edge longer than `longest_edge` (m, > 0). Neighbors share the middle of
// an edge: a closed mesh stays closed. The vertices of `mesh` come first.
TriangleMesh refined(TriangleMesh mesh, double longest_edge);

}  // namespace robot_tissue
