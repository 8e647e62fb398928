#include "known_minima.h"

#include <algorithm>
#include <iterator>

#include "mesh_minima.h"
#include "tuning.h"

namespace robot_tissue {

void KnownMinima::beginSearch() {
  ++searches_;
  for (auto known = of_triangles_.begin(); known != of_triangles_.end();) {
    const bool is_old = known->second.asked_in + 2 < searches_;
    known = is_old ? of_triangles_.erase(known) : std::next(known);
  }
}

// A hollow that was not below the limit came nearer by twice the way at most (its distance changes
// by the way, and the triangle's other places by as much): far from touching.
std::optional<std::vector<TriangleMinimum>> KnownMinima::follow(int triangle,
                                                                const CollisionShape& shape,
                                                                const Corners& corners,
                                                                double accuracy, double limit) {
  const auto found = of_triangles_.find(triangle);
  if (found == of_triangles_.end() || found->second.limit != limit) return std::nullopt;
  Known& known = found->second;
  double way = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    way = std::max(way, (corners[k] - known.corners[k]).norm());
  }
  if (!(way <= tuning::kFollowed * longestEdge(corners))) return std::nullopt;
  known.asked_in = searches_;
  std::vector<TriangleMinimum> minima;
  for (const TriangleMinimum& before : known.minima) {
    const Vec3 point = pointOf(corners, before.weights);
    const TriangleMinimum there{
        before.weights, shape.distanceWithin(point, boundAfter(before.distance.value, way))};
    keepApart(way > accuracy ? localMinimum(shape, corners, there, accuracy) : there, corners,
              minima);
  }
  return minima;
}

void KnownMinima::note(int triangle, const Corners& corners, double limit,
                       const std::vector<TriangleMinimum>& minima) {
  of_triangles_[triangle] = {corners, limit, minima, searches_};
}

}  // namespace robot_tissue
