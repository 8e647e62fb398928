// Points with whole coordinates, and the signs of areas and volumes between them without rounding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

__extension__ using Wide = __int128;

// Coordinates from 0 to 2^40: a volume of three differences stays below 2^123.
using ExactPoint = std::array<std::int64_t, 3>;

// The nearest points of a grid of 2^-40 of the largest extent; that extent must not be zero.
std::vector<ExactPoint> exactPoints(const std::vector<Vec3>& vertices);

// > 0: a, b, c turns counter-clockwise, seen with axis u to the right and axis v up.
inline int turn(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, std::size_t u,
                std::size_t v) {
  const Wide area = static_cast<Wide>(b[u] - a[u]) * (c[v] - a[v]) -
                    static_cast<Wide>(b[v] - a[v]) * (c[u] - a[u]);
  return area > 0 ? 1 : area < 0 ? -1 : 0;
}

// Twice the area vector of a triangle.
std::array<Wide, 3> areaVector(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c);

// > 0: seen from d the triangle a, b, c turns counter-clockwise; 0: all in one plane.
int side(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d);

}  // namespace robot_tissue
