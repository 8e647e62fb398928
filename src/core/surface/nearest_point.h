// Points of the displayed surface by where they are.
#pragma once

#include <optional>
#include <vector>

#include "robot_tissue/core/surface.h"

namespace robot_tissue {

struct NearestPoint {
  SurfacePoint on;        // the surface
  double distance = 0.0;  // m
};

// `vertices`: of the surface, at rest or deformed. Of one triangle; at an infinite distance where
// it has collapsed.
NearestPoint nearestIn(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       int triangle, const Vec3& point);

// Of the triangles that are as near but for
// `alike` (m), such as the two sides of a cut, that one whose inner place is nearest to `inside`.
// None where the surface has no triangles.
std::optional<NearestPoint> nearestPoint(const TissueSurface& surface,
                                         const std::vector<Vec3>& vertices, const Vec3& point);
std::optional<NearestPoint> nearestAtRest(const TissueSurface& surface, const Vec3& point,
                                          double alike, const Vec3& inside, double depth);

// A place so deep below the middle of the triangle, at rest (m).
Vec3 innerPlace(const TissueSurface& surface, int triangle, double depth);

// At rest (m).
Vec3 restOf(const TissueSurface& surface, const SurfacePoint& point);

}  // namespace robot_tissue
