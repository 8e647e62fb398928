#include "mesh_minima.h"

#include <algorithm>

#include "tuning.h"

namespace robot_tissue {
namespace {

// Whether a deepest place found before is one contact with another place: it is nearer than a share
// of the edge, or than the known one is deep. The ball of that radius around the known place is
// inside the mesh, so both are in the same part of it.
bool standsFor(const TriangleMinimum& known, const Vec3& point, const Corners& corners) {
  const double apart = (pointOf(corners, known.weights) - point).norm();
  return apart <= std::max(tuning::kSamePlace * longestEdge(corners), -known.distance.value);
}

bool isKnown(const Vec3& point, double distance, const Corners& corners,
             const std::vector<TriangleMinimum>& minima) {
  return std::any_of(minima.begin(), minima.end(), [&](const TriangleMinimum& known) {
    return known.distance.value <= distance && standsFor(known, point, corners);
  });
}

// Of places that are one contact the deepest stays.
void keep(const TriangleMinimum& found, const Corners& corners,
          std::vector<TriangleMinimum>& minima) {
  if (isKnown(pointOf(corners, found.weights), found.distance.value, corners, minima)) return;
  minima.erase(std::remove_if(minima.begin(), minima.end(),
                              [&](const TriangleMinimum& known) {
                                return standsFor(found, pointOf(corners, known.weights), corners);
                              }),
               minima.end());
  minima.push_back(found);
}

}  // namespace

std::vector<TriangleMinimum> meshMinima(MeshSeeds& seeds, const CollisionShape& shape,
                                        const Corners& corners, const std::vector<int>& faces,
                                        double accuracy, double limit) {
  std::vector<TriangleMinimum> minima;
  const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!(area.norm() > 0.0)) return minima;
  // A signed distance changes by no more than the way between two points: where the center is
  // farther than the limit and the widest corner, no point is within the limit.
  const Vec3 center = (corners[0] + corners[1] + corners[2]) / 3.0;
  double widest = 0.0;
  for (const Vec3& corner : corners) widest = std::max(widest, (corner - center).norm());
  const auto found_at_center = shape.distanceNear(center, limit + widest);
  if (!found_at_center) return minima;
  const double at_center = found_at_center->value;

  const ToolMesh& mesh = shape.mesh();
  const double reach = std::max(0.0, shape.padding() + limit);
  if (faces.empty() && at_center >= limit) return minima;
  for (const Vec3& seed : seeds.on(corners, mesh, faces, reach)) {
    const Vec3 start = pointOf(corners, seed);
    const double bound = boundAfter(at_center, (start - center).norm());
    const TriangleMinimum there{seed, shape.distanceWithin(start, bound)};
    if (isKnown(start, there.distance.value, corners, minima)) continue;
    const TriangleMinimum found = localMinimum(shape, corners, there, accuracy);
    if (found.distance.value < limit) keep(found, corners, minima);
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [](const TriangleMinimum& a, const TriangleMinimum& b) {
                     return a.distance.value < b.distance.value;
                   });
  return minima;
}

}  // namespace robot_tissue
