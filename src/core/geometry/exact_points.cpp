#include "geometry/exact_points.h"

#include <cmath>

namespace robot_tissue {

std::vector<ExactPoint> exactPoints(const std::vector<Vec3>& vertices) {
  const Box box = boundsOf(vertices);
  const double steps = std::ldexp(1.0, 40) / (box.max() - box.min()).maxCoeff();
  std::vector<ExactPoint> points;
  for (const Vec3& vertex : vertices) {
    ExactPoint point{};
    for (int axis = 0; axis < 3; ++axis) {
      point[at(axis)] = std::llround((vertex[axis] - box.min()[axis]) * steps);
    }
    points.push_back(point);
  }
  return points;
}

std::array<Wide, 3> areaVector(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  std::array<Wide, 3> area{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    area[axis] = static_cast<Wide>(b[u] - a[u]) * (c[v] - a[v]) -
                 static_cast<Wide>(b[v] - a[v]) * (c[u] - a[u]);
  }
  return area;
}

int side(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  const std::array<Wide, 3> area = areaVector(a, b, c);
  Wide volume = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) volume += area[axis] * (d[axis] - a[axis]);
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

}  // namespace robot_tissue
