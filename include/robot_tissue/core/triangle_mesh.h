// A surface as plain triangles, and operations on it that need no lattice (own).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

using MeshTriangle = std::array<int, 3>;

struct TriangleMesh {
  std::vector<Vec3> vertices;           // tissue frame (m)
  std::vector<MeshTriangle> triangles;  // counter-clockwise seen from outside
};

// Smallest box that holds the vertices; coordinates that are no number (NaN) do not count. Written
// without branches: of a surface it is asked for at each look of a tool.
class VertexBounds {
 public:
  void add(const Vec3& vertex) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double here = vertex[static_cast<int>(k)];
      low_[k] = here < low_[k] ? here : low_[k];
      high_[k] = here > high_[k] ? here : high_[k];
    }
  }
  Box box() const { return {Vec3(low_[0], low_[1], low_[2]), Vec3(high_[0], high_[1], high_[2])}; }

 private:
  static constexpr double kMost = std::numeric_limits<double>::max();
  std::array<double, 3> low_ = {kMost, kMost, kMost}, high_ = {-kMost, -kMost, -kMost};
};

Box boundsOf(const std::vector<Vec3>& vertices);  // empty without vertices

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
