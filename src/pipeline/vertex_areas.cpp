#include "vertex_areas.h"

#include "robot_tissue/core/triangle_mesh.h"
#include "tuning.h"

namespace robot_tissue {

void VertexAreas::takeSurface(const TissueSurface& surface) {
  if (revision_ != 0 && revision_ == surface.revision) return;
  revision_ = surface.revision;
  first_.assign(surface.rest.size() + 1, 0);
  for (const MeshTriangle& corners : surface.triangles) {
    for (const int corner : corners) ++first_[at(corner) + 1];
  }
  for (std::size_t vertex = 1; vertex < first_.size(); ++vertex) {
    first_[vertex] += first_[vertex - 1];
  }
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  triangles_.resize(first_.back());
  for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
    for (const int corner : surface.triangles[triangle]) {
      triangles_[next[at(corner)]++] = static_cast<int>(triangle);
    }
  }
}

Vec3 VertexAreas::doubleAreaAt(int vertex, const TissueSurface& surface,
                               const std::vector<Vec3>& vertices) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = first_[at(vertex)]; i < first_[at(vertex) + 1]; ++i) {
    sum += doubleArea(vertices, surface.triangles[at(triangles_[i])]);
  }
  return sum;
}

Vec3 VertexAreas::doubleAreaBeside(int triangle, int vertex, const TissueSurface& surface,
                                   const std::vector<Vec3>& vertices) const {
  const Vec3 own = doubleArea(surface.rest, surface.triangles[at(triangle)]).normalized();
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = first_[at(vertex)]; i < first_[at(vertex) + 1]; ++i) {
    const MeshTriangle& corners = surface.triangles[at(triangles_[i])];
    const Vec3 at_rest = doubleArea(surface.rest, corners);
    if (own.dot(at_rest) >= tuning::kSharpFold * at_rest.norm())
      sum += doubleArea(vertices, corners);
  }
  return sum;
}

}  // namespace robot_tissue
