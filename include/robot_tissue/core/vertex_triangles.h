// Which triangles of a mesh meet at each of its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

class VertexTriangles {
 public:
  // False: it is what was taken last, as its revision tells (0 never does), and is not looked at.
  bool take(const std::vector<MeshTriangle>& triangles, std::size_t vertex_count,
            std::uint64_t revision = 0);

  struct Range {
    const int *first = nullptr, *last = nullptr;
    const int* begin() const { return first; }
    const int* end() const { return last; }
  };
  // Ascending.
  Range around(int vertex) const {
    const int* const begin = first_.data() + vertex;
    return {triangles_.data() + begin[0], triangles_.data() + begin[1]};
  }

 private:
  std::uint64_t revision_ = 0;  // of what was taken; 0: none yet
  std::vector<int> triangles_;  // of each vertex
  std::vector<int> first_;      // per vertex, in triangles_, and their end
};

}  // namespace robot_tissue
