// The smooth surface that a surface's triangles stand for: over each a cubic patch through its
// corners, across their normals (PN triangles: Vlachos et al. 2001). Sharp where the surface at
// rest is. It is what is drawn, and what tools touch (own).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/sparse_values.h"
#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/vertex_triangles.h"

namespace robot_tissue {

class CurvedSurface {
 public:
  // Cosine of the angle by which neighboring triangles at rest meet in a sharp edge: 40 degrees.
  // More: blunt edges of an organ are sharp, too. Chosen.
  static constexpr double kSharpFold = 0.766;
  // Of the length of an edge (1), by which a normal at its end lifts it at most. More: rounder
  // where the lattice folds, to the point of bulges. Chosen.
  static constexpr double kMostRise = 0.5;

  // Weights of a triangle's normal in those of its corners (m^-2; Max 1999), from its place at
  // rest: exact there where the vertices are those of a sphere, and the same whichever diagonal
  // halves a square. As the tissue is stretched they stay, so that no normal turns with what grows
  // beside it.
  static Vec3 cornerWeights(const std::vector<Vec3>& rest, const MeshTriangle& corners);

  // Sets the surface that all queries below refer to, with its vertices at these places (m, as many
  // as surface.rest). The vertices are copied. The surface is kept by pointer and read by later
  // queries: it must live, unchanged, until the next take() or the last query. A surface with the
  // revision of the last one counts as the same (0 never does), and is not looked at as a whole;
  // what was found for the same vertices stays.
  void take(const TissueSurface& surface, const std::vector<Vec3>& vertices);

  // Queries check nothing. Before them take() was called; triangle and vertex are indices into that
  // surface, barycentric weights sum to 1. Results are cached: not for several threads at once.

  // Unit normal outwards, even from corner to corner of the point's triangle; zero where it has
  // none, as where all triangles around its corners have no area.
  Vec3 normalAt(const SurfacePoint& point) const;
  // How far the surface is from the triangle's point (m); zero at corners.
  Vec3 bulgeAt(const SurfacePoint& point) const;
  // How it changes with the weight of each corner, the others as they are: a column each (m).
  Eigen::Matrix3d bulgeSlopesAt(const SurfacePoint& point) const;
  // Where it is hollow, how fast its normal turns against the way along it (1/m): symmetric, of no
  // negative direction. Zero where the point's triangle has no area.
  Eigen::Matrix3d hollowAt(const SurfacePoint& point) const;
  // Twice the sum of the areas of all triangles at the vertex, outwards (m^2).
  Vec3 doubleAreaAt(int vertex) const;

 private:
  // What was asked for of a triangle.
  struct OfTriangle {
    Vec3 rest_normal = Vec3::Zero();     // unit
    Vec3 corner_weights = Vec3::Zero();  // at rest
    Vec3 normal = Vec3::Zero();          // unit
    std::uint64_t shape = 0;             // that the normal is of; 0: of none
  };
  struct OfCorners {
    std::array<Vec3, 3> normals;  // unit
    std::array<bool, 3> are_found{};
  };

  OfTriangle& ofTriangle(int triangle) const;
  const Vec3& triangleNormal(int triangle, OfTriangle& known) const;
  Vec3 cornerNormal(int triangle, std::size_t corner) const;
  double riseOf(int triangle, int corner, int other) const;
  Vec3 findCornerNormal(int triangle, std::size_t corner) const;

  const MeshTriangle& cornersOf(int triangle) const { return surface_->triangles[at(triangle)]; }

  const TissueSurface* surface_ = nullptr;  // that was taken last
  VertexTriangles triangles_;
  std::vector<Vec3> vertices_;  // m
  std::uint64_t shape_ = 0;     // counts surfaces, and their vertices
  // Tools touch few triangles: of those alone.
  mutable SparseValues<OfTriangle> of_triangles_;
  mutable SparseValues<OfCorners> of_corners_;  // of this shape
};

}  // namespace robot_tissue
