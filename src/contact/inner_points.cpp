#include "inner_points.h"

#include <algorithm>
#include <map>
#include <optional>

#include "robot_tissue/core/disjoint_sets.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Triangles of each part of the mesh, the largest first.
std::vector<std::vector<int>> facesOfParts(const ToolMesh& mesh) {
  DisjointSets sets(mesh.vertices().size());
  for (const auto& [a, b, c] : mesh.triangles()) {
    sets.join(a, b);
    sets.join(b, c);
  }
  std::map<int, std::vector<int>> of_set;
  std::vector<double> area;
  for (const MeshTriangle& triangle : mesh.triangles()) {
    of_set[sets.lowest(triangle[0])].push_back(static_cast<int>(area.size()));
    area.push_back(doubleArea(mesh.vertices(), triangle).norm());
  }
  std::vector<std::vector<int>> parts;
  for (auto& [set, faces] : of_set) {
    std::stable_sort(faces.begin(), faces.end(),
                     [&](int one, int other) { return area[at(one)] > area[at(other)]; });
    parts.push_back(std::move(faces));
  }
  return parts;
}

// A ball in the mesh.
struct InnerBall {
  Vec3 middle = Vec3::Zero();
  double radius = 0.0;
};

// The largest that touches the face at its middle from inside: one that is too large shrinks until
// the surface's point next to its middle is on it (Ma, Bae, Choi 2012).
InnerBall ballBehind(const ToolMesh& mesh, int face) {
  const Corners corners = mesh.corners(face);
  const Vec3 foot = (corners[0] + corners[1] + corners[2]) / 3.0;
  const Vec3 inwards = (corners[2] - corners[0]).cross(corners[1] - corners[0]).stableNormalized();
  InnerBall ball;
  double radius = mesh.bounds().diagonal().norm();
  for (int shrinks = 0; shrinks < tuning::kMostShrinks && radius > 0.0; ++shrinks) {
    const Vec3 middle = foot + radius * inwards;
    const auto nearest = mesh.tree().nearest(middle, kInfinity);
    if (!nearest) break;
    if (nearest->distance > ball.radius && mesh.tree().isInside(middle)) {
      ball = {middle, nearest->distance};
    }
    if (nearest->distance >= tuning::kFillsBall * radius) break;
    const Vec3 across = nearest->point - foot;
    radius = across.squaredNorm() / (2.0 * across.dot(inwards));
  }
  return ball;
}

}  // namespace

std::vector<Vec3> innerPoints(const CollisionShape& shape) {
  if (shape.isPlane()) return {};
  if (!shape.isMesh()) return {Vec3::Zero()};
  const std::vector<std::vector<int>> parts = facesOfParts(shape.mesh());
  const std::size_t faces_of_part = std::max<std::size_t>(1, tuning::kInnerBalls / parts.size());
  std::vector<Vec3> points;
  for (const std::vector<int>& faces : parts) {
    InnerBall largest;
    for (std::size_t i = 0; i < std::min(faces_of_part, faces.size()); ++i) {
      const InnerBall ball = ballBehind(shape.mesh(), faces[i]);
      if (ball.radius > largest.radius) largest = ball;
    }
    if (largest.radius > 0.0) points.push_back(largest.middle);
  }
  return points;
}

}  // namespace robot_tissue
