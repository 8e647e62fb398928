#include "robot_tissue/core/vertex_triangles.h"

namespace robot_tissue {

bool VertexTriangles::take(const std::vector<MeshTriangle>& triangles, std::size_t vertex_count,
                           std::uint64_t revision) {
  if (revision_ != 0 && revision_ == revision) return false;
  revision_ = revision;
  first_.assign(vertex_count + 1, 0);
  for (const MeshTriangle& corners : triangles) {
    for (const int corner : corners) ++first_[at(corner) + 1];
  }
  for (std::size_t vertex = 1; vertex < first_.size(); ++vertex) {
    first_[vertex] += first_[vertex - 1];
  }
  std::vector<int> next(first_.begin(), first_.end() - 1);
  triangles_.resize(at(first_.back()));
  for (std::size_t triangle = 0; triangle < triangles.size(); ++triangle) {
    for (const int corner : triangles[triangle]) {
      int& place = next[at(corner)];
      triangles_[at(place++)] = static_cast<int>(triangle);
    }
  }
  return true;
}

}  // namespace robot_tissue
