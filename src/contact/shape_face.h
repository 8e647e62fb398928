// The flat face of one shape at a point, with its sharp edges (own). Boxes and cylinders' ends by
// formula; of meshes the edges where they fold outwards.
#pragma once

#include <optional>
#include <vector>

#include "collision_shape.h"

namespace robot_tissue {

// All in one frame: the shape's, as faceOf has it.
struct ShapeFace {
  struct Edge {
    Vec3 outward = Vec3::Zero();  // in the face, across the edge; unit
    double depth_m = 0.0;         // of the point inside it; < 0: beyond it
    Vec3 foot = Vec3::Zero();     // of the point on it, without padding (m)
  };
  Vec3 normal = Vec3::Zero();  // unit, out of the shape
  double height_m = 0.0;       // of the point over the face, padding included
  std::vector<Edge> edges;     // of meshes those within reach, the nearest first
};

bool hasFlatFaces(const CollisionShape& shape);

// The face that looks along `facing`, where the shape has one; of a mesh with an edge within
// `reach` (m) of the point along the face, over it or beyond it.
std::optional<ShapeFace> faceOf(const CollisionShape& shape, const Vec3& facing, const Vec3& point,
                                double reach);

}  // namespace robot_tissue
