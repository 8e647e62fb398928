// Which triangles of the deformed surface may touch a shape, by FCL's traversal of the surface's
// tree and, beside a mesh, of the mesh's.
#pragma once

#include <utility>
#include <vector>

#include "placed_link.h"
#include "triangle_bvh.h"

namespace robot_tissue {

// Ascending: all triangles that have a point nearer to the shape than the margin (m), or inside,
// and some more.
std::vector<int> trianglesNear(const PlacedShape& shape, const TriangleBvh& surface, double margin);

// Of a mesh: pairs of a triangle and a face, ascending; all that are nearer to each other than the
// margin (m) and the padding, and some more.
class FacePairs {
 public:
  FacePairs() = default;
  FacePairs(const PlacedShape& mesh, const TriangleBvh& surface, double margin);
  // Of one triangle, ascending.
  void facesNear(int triangle, std::vector<int>& faces) const;

 private:
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace robot_tissue
