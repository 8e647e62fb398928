#include "geometry/tetrahedron.h"

#include <Eigen/Geometry>
#include <cmath>

namespace robot_tissue {
namespace {

// Adds what of the solid is in the half space. With one corner inside that is a tetrahedron, with
// two a wedge, with three all but a tetrahedron at the fourth; the latter two are three each.
void clip(const HalfSpace& half, const Tetrahedron& solid, std::vector<Tetrahedron>& inside) {
  Tetrahedron corners;  // those inside first
  std::array<double, 4> height{};
  std::size_t count = 0, outside = 4;
  for (const Vec3& corner : solid) {
    const double above = half.normal.dot(corner) - half.offset;
    const std::size_t place = above <= 0.0 ? count++ : --outside;
    corners[place] = corner;
    height[place] = above;
  }
  const auto between = [&](std::size_t low, std::size_t high) -> Vec3 {
    const double share = height[low] / (height[low] - height[high]);
    return corners[low] + share * (corners[high] - corners[low]);
  };
  if (count == 4) inside.push_back(solid);
  if (count == 1) inside.push_back({corners[0], between(0, 1), between(0, 2), between(0, 3)});
  if (count == 2) {
    const Vec3 a = between(0, 2), b = between(0, 3), c = between(1, 2), d = between(1, 3);
    inside.push_back({corners[0], a, b, corners[1]});
    inside.push_back({a, b, corners[1], c});
    inside.push_back({b, corners[1], c, d});
  }
  if (count == 3) {
    const Vec3 a = between(0, 3), b = between(1, 3), c = between(2, 3);
    inside.push_back({corners[0], corners[1], corners[2], a});
    inside.push_back({corners[1], corners[2], a, b});
    inside.push_back({corners[2], a, b, c});
  }
}

}  // namespace

// With s the sum of the corners p and V the volume (integrals of products of barycentric
// coordinates are V times 1/4, 1/20 and 1/120 of sums over the corners):
//   x: V/4 s,  x x^T: V/20 (s s^T + sum of p p^T),
//   xyz: V/120 (s_x s_y s_z + sum of (p_x p_y s_z + p_y p_z s_x + p_z p_x s_y + 2 p_x p_y p_z)).
FillIntegrals integralsOver(const Tetrahedron& solid) {
  const Vec3 a = solid[1] - solid[0], b = solid[2] - solid[0], c = solid[3] - solid[0];
  const double volume = std::abs(a.cross(b).dot(c)) / 6.0;
  const Vec3 sum = solid[0] + solid[1] + solid[2] + solid[3];
  FillIntegrals integrals;
  integrals.volume = volume;
  integrals.first = 0.25 * volume * sum;
  integrals.second = sum * sum.transpose();
  integrals.triple = sum.prod();
  for (const Vec3& p : solid) {
    integrals.second += p * p.transpose();
    integrals.triple += p.x() * p.y() * sum.z() + p.y() * p.z() * sum.x() +
                        p.z() * p.x() * sum.y() + 2.0 * p.prod();
  }
  integrals.second *= 0.05 * volume;
  integrals.triple *= volume / 120.0;
  return integrals;
}

FillIntegrals integralsWithin(const std::vector<HalfSpace>& halves, const Tetrahedron& solid) {
  std::vector<Tetrahedron> left = {solid}, inside;
  for (const HalfSpace& half : halves) {
    inside.clear();
    for (const Tetrahedron& each : left) clip(half, each, inside);
    left.swap(inside);
  }
  FillIntegrals sum;
  for (const Tetrahedron& each : left) sum += integralsOver(each);
  return sum;
}

}  // namespace robot_tissue
