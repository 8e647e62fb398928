// The point of a triangle that is nearest to another one.
#pragma once

#include <array>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

using Corners = std::array<Vec3, 3>;

// Twice the triangle's area, along its normal (m^2).
inline Vec3 doubleArea(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

// Weights of the triangle's point that is nearest to p; sum to 1. Ericson, "Real-Time Collision
// Detection", section 5.1.5: Voronoi regions of the triangle.
inline Vec3 nearestInTriangle(const Vec3& p, const Corners& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return Vec3(1.0, 0.0, 0.0);
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return Vec3(0.0, 1.0, 0.0);
  const double area_c = d1 * d4 - d3 * d2;
  if (area_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return Vec3(1.0 - t, t, 0.0);
  }
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return Vec3(0.0, 0.0, 1.0);
  const double area_b = d5 * d2 - d1 * d6;
  if (area_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return Vec3(1.0 - t, 0.0, t);
  }
  const double area_a = d3 * d6 - d5 * d4;
  if (area_a <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return Vec3(0.0, 1.0 - t, t);
  }
  return Vec3(area_a, area_b, area_c) / (area_a + area_b + area_c);
}

// Point by weights of the corners, which sum to 1.
inline Vec3 pointOf(const Corners& corners, const Vec3& weights) {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

}  // namespace robot_tissue
