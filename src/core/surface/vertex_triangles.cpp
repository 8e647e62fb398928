#include "robot_tissue/core/vertex_triangles.h"

namespace robot_tissue {

bool VertexTriangles::take(const TissueSurface& surface) {
  if (revision_ != 0 && revision_ == surface.revision) return false;
  revision_ = surface.revision;
  first_.assign(surface.rest.size() + 1, 0);
  for (const MeshTriangle& corners : surface.triangles) {
    for (const int corner : corners) ++first_[at(corner) + 1];
  }
  for (std::size_t vertex = 1; vertex < first_.size(); ++vertex) {
    first_[vertex] += first_[vertex - 1];
  }
  std::vector<int> next(first_.begin(), first_.end() - 1);
  triangles_.resize(at(first_.back()));
  for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
    for (const int corner : surface.triangles[triangle]) {
      int& place = next[at(corner)];
      triangles_[at(place++)] = static_cast<int>(triangle);
    }
  }
  return true;
}

}  // namespace robot_tissue
