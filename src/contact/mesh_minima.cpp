#include "mesh_minima.h"

#include <algorithm>
#include <limits>

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

// Whether the nearest of the deepest places found before is in the same hollow: half way there the
// distance is no greater than by a straight line. Else a search from here would lead elsewhere.
bool isInHollowOf(const std::vector<TriangleMinimum>& minima, const TriangleMinimum& there,
                  const CollisionShape& shape, const Corners& corners) {
  const TriangleMinimum* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  const Vec3 point = pointOf(corners, there.weights);
  for (const TriangleMinimum& known : minima) {
    const double apart = (pointOf(corners, known.weights) - point).norm();
    if (known.distance.value > there.distance.value || apart >= least) continue;
    least = apart;
    nearest = &known;
  }
  if (nearest == nullptr) return false;
  const Vec3 middle = pointOf(corners, Vec3(0.5 * (there.weights + nearest->weights)));
  const double bound = boundAfter(nearest->distance.value, 0.5 * least);
  const double straight = 0.5 * (there.distance.value + nearest->distance.value);
  return shape.distanceWithin(middle, bound).value <= straight;
}

// Nearer to a convex part that is not met there: from its nearest point back to the triangle, and
// so on (alternating projections, Cheney and Goldstein 1959).
TriangleMinimum approached(const CollisionShape& shape, const Corners& corners,
                           TriangleMinimum there) {
  for (int step = 0; step < tuning::kApproaches && there.distance.value > 0.0; ++step) {
    const Vec3 point = pointOf(corners, there.weights);
    const Vec3 weights =
        nearestInTriangle(point - there.distance.value * there.distance.slope, corners);
    const double way = (pointOf(corners, weights) - point).norm();
    const SignedDistance distance =
        shape.distanceWithin(pointOf(corners, weights), boundAfter(there.distance.value, way));
    if (!(distance.value < there.distance.value)) break;
    there = {weights, distance};
  }
  return there;
}

}  // namespace

void keepApart(const TriangleMinimum& found, const Corners& corners,
               std::vector<TriangleMinimum>& minima) {
  if (isKnown(pointOf(corners, found.weights), found.distance.value, corners, minima)) return;
  minima.erase(std::remove_if(minima.begin(), minima.end(),
                              [&](const TriangleMinimum& known) {
                                return standsFor(found, pointOf(corners, known.weights), corners);
                              }),
               minima.end());
  minima.push_back(found);
}

std::vector<TriangleMinimum> meshMinima(MeshSeeds& seeds, const CollisionShape& shape,
                                        const Corners& corners, const std::vector<int>& faces,
                                        double accuracy, double limit,
                                        std::optional<double> at_first_corner) {
  std::vector<TriangleMinimum> minima;
  const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (!(area.norm() > 0.0)) return minima;
  // A signed distance changes by no more than the way between two points: where the center is
  // farther than the limit and the widest corner, no point is within the limit.
  const Vec3 center = (corners[0] + corners[1] + corners[2]) / 3.0;
  double widest = 0.0;
  for (const Vec3& corner : corners) widest = std::max(widest, (corner - center).norm());
  const double way = (center - corners[0]).norm();
  const auto of_center =
      at_first_corner
          ? std::optional(shape.distanceWithin(center, boundAfter(*at_first_corner, way)))
          : shape.distanceNear(center, limit + widest);
  if (!of_center || of_center->value > limit + widest) return minima;
  const double at_center = of_center->value;

  const ToolMesh& mesh = shape.mesh();
  const double reach = std::max(0.0, shape.padding() + limit);
  if (faces.empty() && at_center >= limit) return minima;
  const std::vector<Vec3>& all_seeds = seeds.on(corners, mesh, faces, reach);
  for (const Vec3& seed : all_seeds) {
    const Vec3 start = pointOf(corners, seed);
    const bool is_center = &seed == &all_seeds.back();
    const double bound = boundAfter(at_center, (start - center).norm());
    const TriangleMinimum there{seed, is_center ? *of_center : shape.distanceWithin(start, bound)};
    if (isKnown(start, there.distance.value, corners, minima)) continue;
    if (isInHollowOf(minima, there, shape, corners)) continue;
    const bool is_alone = all_seeds.size() == 1;
    const TriangleMinimum found = localMinimum(
        shape, corners, is_alone ? approached(shape, corners, there) : there, accuracy);
    if (found.distance.value < limit) keepApart(found, corners, minima);
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [](const TriangleMinimum& a, const TriangleMinimum& b) {
                     return a.distance.value < b.distance.value;
                   });
  return minima;
}

}  // namespace robot_tissue
