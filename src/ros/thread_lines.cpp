#include "thread_lines.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/triangle_mesh.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Of the skin around a point, unit: mean by area of the triangles that no cut opened with a corner
// within a spacing. Zero where there are none.
Vec3 skinNormal(const Tissue& tissue, const Vec3& point) {
  const TissueSurface& surface = tissue.surface();
  const double reach = tissue.lattice().spacing();
  Vec3 normal = Vec3::Zero();
  for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
    if (surface.opened[triangle] != 0) continue;
    const MeshTriangle& corners = surface.triangles[triangle];
    const bool is_near = std::any_of(corners.begin(), corners.end(), [&](int vertex) {
      return (tissue.vertices()[at(vertex)] - point).norm() <= reach;
    });
    if (is_near) normal += doubleArea(tissue.vertices(), corners);
  }
  const double length = normal.norm();
  return length > 0.0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

}  // namespace

std::vector<Vec3> threadLines(const Tissue& tissue) {
  const double height = tuning::kThreadHeight * tissue.lattice().spacing();
  std::vector<Vec3> lines;
  for (const SutureReport& suture : tissue.sutures()) {
    if (suture.broken) continue;
    const Vec3 from_normal = skinNormal(tissue, suture.from);
    const Vec3 to_normal = skinNormal(tissue, suture.to);
    Vec3 before = suture.from;
    for (int part = 1; part <= tuning::kThreadParts; ++part) {
      const double share = static_cast<double>(part) / tuning::kThreadParts;
      const Vec3 up = (1.0 - share) * from_normal + share * to_normal;
      const double lift = height * std::sqrt(4.0 * share * (1.0 - share));
      const Vec3 point = (1.0 - share) * suture.from + share * suture.to + lift * up;
      lines.push_back(before);
      lines.push_back(point);
      before = point;
    }
  }
  return lines;
}

}  // namespace robot_tissue
