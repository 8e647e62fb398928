// How deep a link is inside a closed surface.
#pragma once

#include <functional>
#include <vector>

#include "clear_points.h"
#include "placed_link.h"
#include "triangle_bvh.h"

namespace robot_tissue {

// Points of the padded surface in the shape's own frame (m): corners, edges and faces of a box,
// rims, caps and sides of a cylinder, evenly spread points of a sphere, vertices of a mesh and
// middles of its long edges. None for a plane.
std::vector<Vec3> surfacePoints(const CollisionShape& shape);

// Of the points (shape's frame), the depth of the deepest inside the surface (m), or `known` when
// none is deeper: the distance to the nearest triangle. For a convex shape the deepest one then
// moves on to where the shape reaches farthest from that triangle, so that it is exact over a flat
// surface. The surface is off its triangles by `bulge` (m). A look was begun of `clear`: points
// that are still clear are left out.
using PointBulge = std::function<Vec3(const SurfacePoint& point)>;
double deepestInside(const PlacedShape& placed, const std::vector<Vec3>& points,
                     const TriangleBvh& surface, const PointBulge& bulge, double known,
                     ClearPoints& clear);

}  // namespace robot_tissue
