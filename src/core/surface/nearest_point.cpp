#include "surface/nearest_point.h"

#include <limits>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/triangle_point.h"

namespace robot_tissue {
namespace {

Corners cornersOf(const std::vector<Vec3>& vertices, const MeshTriangle& triangle) {
  return {vertices[at(triangle[0])], vertices[at(triangle[1])], vertices[at(triangle[2])]};
}

}  // namespace

NearestPoint nearestIn(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       int triangle, const Vec3& point) {
  const Corners corners = cornersOf(vertices, surface.triangles[at(triangle)]);
  NearestPoint nearest;
  nearest.on = {triangle, nearestInTriangle(point, corners)};
  nearest.distance = (pointOf(corners, nearest.on.barycentric) - point).norm();
  if (!(nearest.distance < std::numeric_limits<double>::infinity())) {
    nearest.distance = std::numeric_limits<double>::infinity();
  }
  return nearest;
}

std::optional<NearestPoint> nearestPoint(const TissueSurface& surface,
                                         const std::vector<Vec3>& vertices, const Vec3& point) {
  std::optional<NearestPoint> nearest;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const NearestPoint here = nearestIn(surface, vertices, static_cast<int>(i), point);
    if (!nearest || here.distance < nearest->distance) nearest = here;
  }
  return nearest;
}

std::optional<NearestPoint> nearestAtRest(const TissueSurface& surface, const Vec3& point,
                                          double alike, const Vec3& inside, double depth) {
  const std::optional<NearestPoint> least = nearestPoint(surface, surface.rest, point);
  if (!least) return least;
  NearestPoint chosen = *least;
  double off = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const int triangle = static_cast<int>(i);
    const NearestPoint here = nearestIn(surface, surface.rest, triangle, point);
    if (!(here.distance <= least->distance + alike)) continue;
    const double from_inside = (innerPlace(surface, triangle, depth) - inside).norm();
    if (from_inside >= off) continue;
    off = from_inside;
    chosen = here;
  }
  return chosen;
}

Vec3 innerPlace(const TissueSurface& surface, int triangle, double depth) {
  const MeshTriangle& corners = surface.triangles[at(triangle)];
  Vec3 middle = Vec3::Zero();
  for (const int corner : corners) middle += surface.rest[at(corner)] / 3.0;
  const Vec3 area = doubleArea(surface.rest, corners);
  const double size = area.norm();
  return size > 0.0 ? Vec3(middle - depth / size * area) : middle;
}

Vec3 restOf(const TissueSurface& surface, const SurfacePoint& point) {
  return pointOf(cornersOf(surface.rest, surface.triangles[at(point.triangle)]), point.barycentric);
}

}  // namespace robot_tissue
