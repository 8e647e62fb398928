#include "surface/smooth_part.h"

#include <algorithm>

#include "robot_tissue/core/curved_surface.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {
namespace {

// Of the reach (1): so far around the middle the surface tells which way all of it looks. Chosen.
constexpr double kMiddle = 0.4;

// Whether it is new.
bool note(SparseValues<char>& known, int number) {
  if (known.find(number) != nullptr) return false;
  known.add(number);
  return true;
}

Vec3 middleOf(const std::vector<Vec3>& places, const MeshTriangle& corners) {
  return (places[at(corners[0])] + places[at(corners[1])] + places[at(corners[2])]) / 3.0;
}

}  // namespace

void SmoothParts::take(const TissueSurface& surface) {
  surface_ = &surface;
  triangles_.take(surface.triangles, surface.rest.size(), surface.revision);
}

// Twice: the point may be beside the middle, where the surface looks elsewhere.
SmoothPart SmoothParts::around(const SurfacePoint& point, const Vec3& middle, double reach) {
  const std::vector<Vec3>& rest = surface_->rest;
  const Vec3 outwards = doubleArea(rest, surface_->triangles[at(point.triangle)]);
  SmoothPart part = lookingLike(outwards.stableNormalized(), point, middle, reach);
  Vec3 in_the_middle = Vec3::Zero();
  for (const int triangle : part.triangles) {
    const MeshTriangle& corners = surface_->triangles[at(triangle)];
    const bool is_near = (middleOf(rest, corners) - middle).norm() <= kMiddle * reach;
    if (is_near) in_the_middle += doubleArea(rest, corners);
  }
  const Vec3 there = in_the_middle.stableNormalized();
  if (!(there.dot(outwards) >= CurvedSurface::kSharpFold * outwards.norm())) return part;
  return lookingLike(there, point, middle, reach);
}

SmoothPart SmoothParts::lookingLike(const Vec3& outwards, const SurfacePoint& point,
                                    const Vec3& middle, double reach) {
  const std::vector<Vec3>& rest = surface_->rest;
  has_vertex_.clearFor(rest.size());
  has_triangle_.clearFor(surface_->triangles.size());
  SmoothPart part;
  const auto is_near = [&](const Vec3& place) {
    return ((place - middle) / reach).squaredNorm() <= 1.0;
  };
  const auto add = [&](int triangle) {
    if (!note(has_triangle_, triangle)) return;
    const MeshTriangle& corners = surface_->triangles[at(triangle)];
    const Vec3 area = doubleArea(rest, corners);
    if (area.dot(outwards) < CurvedSurface::kSharpFold * area.norm()) return;
    if (is_near(middleOf(rest, corners))) part.triangles.push_back(triangle);
    for (const int corner : corners) {
      if (is_near(rest[at(corner)]) && note(has_vertex_, corner)) part.vertices.push_back(corner);
    }
  };
  add(point.triangle);
  for (std::size_t next = 0; next < part.vertices.size(); ++next) {
    for (const int triangle : triangles_.around(part.vertices[next])) add(triangle);
  }
  std::sort(part.vertices.begin(), part.vertices.end());
  return part;
}

Vec3 inwardsAroundDent(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       const SmoothPart& part) {
  Vec3 sum = Vec3::Zero();
  for (const int triangle : part.triangles) {
    sum -= doubleArea(vertices, surface.triangles[at(triangle)]);
  }
  return sum.normalized();
}

}  // namespace robot_tissue
