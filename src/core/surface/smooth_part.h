// The part of a surface around a point, up to where it folds: a place beside an edge knows nothing
// of what is beyond it (own).
#pragma once

#include <vector>

#include "robot_tissue/core/sparse_values.h"
#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/types.h"
#include "robot_tissue/core/vertex_triangles.h"

namespace robot_tissue {

struct SmoothPart {
  std::vector<int> triangles, vertices;
};

class SmoothParts {
 public:
  // Sets the surface that the queries refer to, as VertexTriangles.
  void take(const TissueSurface& surface);
  // What hangs together with the point's triangle over vertices that at rest are within `reach` (m)
  // of the middle, and looks where it does around that: up to CurvedSurface::kSharpFold.
  // Vertices within reach, ascending, and triangles whose middles are.
  SmoothPart around(const SurfacePoint& point, const Vec3& middle, double reach);

 private:
  SmoothPart lookingLike(const Vec3& outwards, const SurfacePoint& point, const Vec3& middle,
                         double reach);

  const TissueSurface* surface_ = nullptr;
  VertexTriangles triangles_;
  SparseValues<char> has_vertex_, has_triangle_;  // of the query
};

// The unit way inwards of the part, the surface's vertices at these places (m). The sum of its
// areas is that of any surface with the same border, and knows no dent inside of it. Zero where
// that is none.
Vec3 inwardsAroundDent(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       const SmoothPart& part);

}  // namespace robot_tissue
