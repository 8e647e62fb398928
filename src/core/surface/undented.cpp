#include "surface/undented.h"

#include "robot_tissue/core/curved_surface.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

Vec3 inwardsAroundDent(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       const SurfacePoint& point, double reach) {
  const std::vector<Vec3>& rest = surface.rest;
  const MeshTriangle& here = surface.triangles[at(point.triangle)];
  const Vec3 outwards = doubleArea(rest, here).normalized();
  Vec3 place = Vec3::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    place += point.barycentric[corner] * rest[at(here[at(corner)])];
  }
  Vec3 sum = Vec3::Zero();
  for (const MeshTriangle& corners : surface.triangles) {
    if ((rest[at(corners[0])] - place).squaredNorm() > reach * reach) continue;
    const Vec3 at_rest = doubleArea(rest, corners);
    if (at_rest.dot(outwards) < CurvedSurface::kSharpFold * at_rest.norm()) continue;
    sum -= doubleArea(vertices, corners);
  }
  return sum.normalized();
}

}  // namespace robot_tissue
