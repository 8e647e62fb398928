// Which triangles of the deformed surface may touch a shape, by FCL's traversal of the surface's
// tree and, beside a mesh, of the mesh's.
#pragma once

#include <cstdint>
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
  std::vector<std::uint64_t> pairs_;  // the triangle above, the face below: one number sorts sooner
};

// The pairs of the last search, as long as they have all that are near: they are sought a little
// farther than asked for, so that they serve while tissue and tool move by less than that.
class KeptFacePairs {
 public:
  // As FacePairs. `tree`: a number that is another one with each other surface; `vertices`: that it
  // was moved to.
  const FacePairs& of(const PlacedShape& mesh, const TriangleBvh& surface, std::uint64_t tree,
                      const std::vector<Vec3>& vertices, double margin);

 private:
  bool holdFor(const Pose& mesh_T_tissue, const std::vector<Vec3>& vertices, double margin) const;

  FacePairs pairs_;
  std::uint64_t tree_ = 0;
  double reach_ = -1.0;         // m: all pairs up to here; < 0: none yet
  std::vector<Vec3> vertices_;  // of the surface in the mesh's frame, then (m)
};

}  // namespace robot_tissue
