// Triangles around the vertices of a surface (own): of how a vertex looks, without a look at all of
// the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/surface.h"

namespace robot_tissue {

class VertexAreas {
 public:
  // Areas are of that surface from now on.
  void takeSurface(const TissueSurface& surface);
  // Twice the sum of the areas of the triangles at the vertex, outwards (m^2), as the vertices are.
  Vec3 doubleAreaAt(int vertex, const TissueSurface& surface,
                    const std::vector<Vec3>& vertices) const;
  // Of those that a sharp edge of the surface at rest does not part from `triangle`, one of them.
  Vec3 doubleAreaBeside(int triangle, int vertex, const TissueSurface& surface,
                        const std::vector<Vec3>& vertices) const;

 private:
  std::uint64_t revision_ = 0;      // of the surface; 0: none yet
  std::vector<int> triangles_;      // of each vertex, ascending
  std::vector<std::size_t> first_;  // per vertex, in triangles_, and their end
};

}  // namespace robot_tissue
