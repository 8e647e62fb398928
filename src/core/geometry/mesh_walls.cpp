#include "robot_tissue/core/mesh_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "geometry/tuning.h"

namespace robot_tissue {
namespace {

constexpr double kMisses = std::numeric_limits<double>::infinity();

// Distance along the ray (m); infinite where it misses. Moller and Trumbore 1997.
double hit(const Vec3& from, const Vec3& along, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 across = along.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0.0) return kMisses;
  const Vec3 there = (from - a) / determinant;
  const double u = there.dot(across);
  const Vec3 turned = there.cross(ab);
  const double v = along.dot(turned);
  const double distance = ac.dot(turned);
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 ? distance : kMisses;
}

Vec3 corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t which) {
  return mesh.vertices[at(mesh.triangles[triangle][which])];
}

// From the middle of the triangle straight in; thickness kMisses where nothing is there, or what is
// there lies aslant.
WallSample sampleAt(const TriangleMesh& mesh, std::size_t triangle) {
  const Vec3 twice = doubleArea(mesh.vertices, mesh.triangles[triangle]);
  WallSample sample{kMisses, twice.normalized(), 0.5 * twice.norm()};
  const Vec3 middle =
      (corner(mesh, triangle, 0) + corner(mesh, triangle, 1) + corner(mesh, triangle, 2)) / 3.0;
  std::size_t next = triangle;
  for (std::size_t other = 0; other < mesh.triangles.size(); ++other) {
    if (other == triangle) continue;
    const double here = hit(middle, -sample.normal, corner(mesh, other, 0), corner(mesh, other, 1),
                            corner(mesh, other, 2));
    if (!(here < sample.thickness)) continue;
    sample.thickness = here;
    next = other;
  }
  const Vec3 opposite = doubleArea(mesh.vertices, mesh.triangles[next]).normalized();
  if (!(-opposite.dot(sample.normal) >= tuning::kNearlyParallel)) sample.thickness = kMisses;
  return sample;
}

}  // namespace

std::vector<WallSample> wallSamples(const TriangleMesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  if (count == 0) return {};
  const std::size_t rays =
      std::clamp(tuning::kMostRayTests / count, tuning::kLeastRays, tuning::kMostRays);
  const std::size_t stride = std::max<std::size_t>(1, count / rays);
  std::vector<WallSample> samples;
  for (std::size_t triangle = 0; triangle < count; triangle += stride) {
    samples.push_back(sampleAt(mesh, triangle));
  }
  return samples;
}

}  // namespace robot_tissue
