#include "geometry/connected_triangles.h"

#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {

std::vector<std::vector<int>> connectedTriangles(const std::vector<MeshTriangle>& triangles,
                                                 const std::vector<int>& among,
                                                 std::size_t vertices) {
  DisjointSets corners(vertices);
  for (const int triangle : among) {
    const MeshTriangle& t = triangles[at(triangle)];
    for (const int corner : {t[1], t[2]}) corners.join(t[0], corner);
  }
  std::vector<std::vector<int>> lists;
  std::vector<int> list_of_root(vertices, -1);
  for (const int triangle : among) {
    int& list = list_of_root[at(corners.lowest(triangles[at(triangle)][0]))];
    if (list < 0) {
      list = static_cast<int>(lists.size());
      lists.emplace_back();
    }
    lists[at(list)].push_back(triangle);
  }
  return lists;
}

}  // namespace robot_tissue
