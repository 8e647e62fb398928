// Parts triangles in two, over and over, for a tree of boxes over them: by the middle of their box
// along its longest side, as FCL's SPLIT_METHOD_BV_CENTER.
#pragma once

#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class TriangleSplitter {
 public:
  // By where the vertices are now, however they move; the triangles must outlive it.
  TriangleSplitter(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles);

  const std::vector<Vec3>& vertices() const { return vertices_; }

  // Numbers of the triangles; those of a node of the tree follow each other.
  int triangleAt(int place) const { return order_[at(place)]; }
  // Parts those at so many places from the first on; at least two. Returns how many are in the
  // first part.
  int split(int first, int count);

 private:
  Box boundsOf(int first, int count) const;
  double centerOf(int triangle, Eigen::Index axis) const;

  const std::vector<Vec3> vertices_;
  const std::vector<MeshTriangle>& triangles_;
  std::vector<int> order_;
};

}  // namespace robot_tissue
