// The point of a triangle that is nearest to another one.
#pragma once

#include <array>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

using Corners = std::array<Vec3, 3>;

// Weights of the triangle's point that is nearest to p; sum to 1.
Vec3 nearestInTriangle(const Vec3& p, const Corners& corners);

// Point by weights of the corners, which sum to 1.
inline Vec3 pointOf(const Corners& corners, const Vec3& weights) {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

}  // namespace robot_tissue
