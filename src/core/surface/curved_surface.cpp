#include "robot_tissue/core/curved_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "robot_tissue/core/same_bits.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

Vec3 CurvedSurface::cornerWeights(const std::vector<Vec3>& rest, const MeshTriangle& corners) {
  const Vec3 &a = rest[at(corners[0])], &b = rest[at(corners[1])], &c = rest[at(corners[2])];
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  const double area = doubleArea(rest, corners).norm();
  const auto weight = [&](double product) { return product > 0.0 ? area / product : 0.0; };
  return {weight(ab * ca), weight(bc * ab), weight(ca * bc)};
}

void CurvedSurface::take(const TissueSurface& surface, const std::vector<Vec3>& vertices) {
  const bool is_known = !triangles_.take(surface.triangles, surface.rest.size(), surface.revision);
  surface_ = &surface;
  if (!is_known) of_triangles_.clearFor(surface.triangles.size());
  if (is_known && areSame(vertices, vertices_)) return;
  vertices_ = vertices;
  ++shape_;
  of_corners_.clearFor(surface.triangles.size());
}

Vec3 CurvedSurface::doubleAreaAt(int vertex) const {
  Vec3 sum = Vec3::Zero();
  for (const int triangle : triangles_.around(vertex)) {
    sum += doubleArea(vertices_, cornersOf(triangle));
  }
  return sum;
}

CurvedSurface::OfTriangle& CurvedSurface::ofTriangle(int triangle) const {
  if (OfTriangle* known = of_triangles_.find(triangle)) return *known;
  OfTriangle& known = of_triangles_.add(triangle);
  const MeshTriangle& corners = cornersOf(triangle);
  known.rest_normal = doubleArea(surface_->rest, corners).stableNormalized();
  known.corner_weights = cornerWeights(surface_->rest, corners);
  return known;
}

const Vec3& CurvedSurface::triangleNormal(int triangle, OfTriangle& known) const {
  if (known.shape == shape_) return known.normal;
  known.normal = doubleArea(vertices_, cornersOf(triangle)).stableNormalized();
  known.shape = shape_;
  return known.normal;
}

Vec3 CurvedSurface::cornerNormal(int triangle, std::size_t corner) const {
  OfCorners* known = of_corners_.find(triangle);
  if (known == nullptr) known = &of_corners_.add(triangle);
  if (!known->are_found[corner]) {
    known->normals[corner] = findCornerNormal(triangle, corner);
    known->are_found[corner] = true;
  }
  return known->normals[corner];
}

// Of the triangles around the corner that no sharp edge parts from its own.
Vec3 CurvedSurface::findCornerNormal(int triangle, std::size_t corner) const {
  const int vertex = cornersOf(triangle)[corner];
  const Vec3 own = ofTriangle(triangle).rest_normal;
  Vec3 sum = Vec3::Zero();
  for (const int other : triangles_.around(vertex)) {
    OfTriangle& of_other = ofTriangle(other);
    if (own.dot(of_other.rest_normal) < kSharpFold) continue;
    const MeshTriangle& corners = cornersOf(other);
    const auto k = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    sum += of_other.corner_weights[k] * triangleNormal(other, of_other);
  }
  return sum.stableNormalized();
}

Vec3 CurvedSurface::normalAt(const SurfacePoint& point) const {
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    normal += point.barycentric[static_cast<int>(k)] * cornerNormal(point.triangle, k);
  }
  return normal.stableNormalized();
}

// Of the normal that goes evenly from corner to corner: N = sum of u_k N_k, dN/dx = sum of N_k
// times the gradient of u_k in the triangle.
Eigen::Matrix3d CurvedSurface::hollowAt(const SurfacePoint& point) const {
  const MeshTriangle& corners = cornersOf(point.triangle);
  const Vec3 area = doubleArea(vertices_, corners);
  if (!std::isnormal(area.squaredNorm())) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 across = vertices_[at(corners[(k + 2) % 3])] - vertices_[at(corners[(k + 1) % 3])];
    const Vec3 gradient = area.cross(across) / area.squaredNorm();
    turn -= cornerNormal(point.triangle, k) * gradient.transpose();
  }
  const Vec3 normal = area.normalized();
  const Eigen::Matrix3d along = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  const Eigen::Matrix3d even = along * (turn + turn.transpose()) * along / 2.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(even);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() *
         parts.eigenvectors().transpose();
}

// The patch has no other control points than those a third along its edges, brought into the
// tangent planes of the edges' ends, and the middle that makes it as quadratic as may be. Less the
// flat triangle, with weights u and the rise w_ij = N_i (x_j - x_i) of corner j over the plane of
// corner i: - sum over i, j != i of w_ij N_i (u_i^2 u_j + u_0 u_1 u_2 / 2).
Vec3 CurvedSurface::bulgeAt(const SurfacePoint& point) const {
  const Vec3& u = point.barycentric;
  Vec3 bulge = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    double lift = 0.0;
    for (int j = 0; j < 3; ++j) {
      if (j != i) lift += riseOf(point.triangle, i, j) * (u[i] * u[i] * u[j] + 0.5 * u.prod());
    }
    bulge -= lift * cornerNormal(point.triangle, at(i));
  }
  return bulge;
}

Eigen::Matrix3d CurvedSurface::bulgeSlopesAt(const SurfacePoint& point) const {
  const Vec3& u = point.barycentric;
  const Vec3 of_product(0.5 * u[1] * u[2], 0.5 * u[2] * u[0], 0.5 * u[0] * u[1]);
  Eigen::Matrix3d slopes = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    Vec3 of_lift = Vec3::Zero();
    for (int j = 0; j < 3; ++j) {
      if (j == i) continue;
      Vec3 of_shape = of_product;
      of_shape[i] += 2.0 * u[i] * u[j];
      of_shape[j] += u[i] * u[i];
      of_lift += riseOf(point.triangle, i, j) * of_shape;
    }
    slopes -= cornerNormal(point.triangle, at(i)) * of_lift.transpose();
  }
  return slopes;
}

// w_ij, within kMostRise.
double CurvedSurface::riseOf(int triangle, int corner, int other) const {
  const MeshTriangle& corners = cornersOf(triangle);
  const Vec3 way = vertices_[at(corners[at(other)])] - vertices_[at(corners[at(corner)])];
  const double most = kMostRise * way.norm();
  return std::min(most, std::max(-most, cornerNormal(triangle, at(corner)).dot(way)));
}

}  // namespace robot_tissue
