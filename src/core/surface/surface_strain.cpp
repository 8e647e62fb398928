#include "robot_tissue/core/surface_strain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {
namespace {

using TriangleCorners = std::array<Vec3, 3>;

TriangleCorners cornersThere(const std::vector<Vec3>& vertices, const MeshTriangle& triangle) {
  return {vertices[at(triangle[0])], vertices[at(triangle[1])], vertices[at(triangle[2])]};
}

// First fundamental form: scalar products of two sides (m^2).
Eigen::Matrix2d metricOf(const TriangleCorners& corners) {
  const Vec3 side = corners[1] - corners[0], other = corners[2] - corners[0];
  Eigen::Matrix2d metric;
  metric << side.dot(side), side.dot(other), side.dot(other), other.dot(other);
  return metric;
}

// The greatest eigenvalue of (rest metric)^-1 (metric) is the square of the stretch.
double greatestStretch(const TriangleCorners& rest, const TriangleCorners& now) {
  const Eigen::Matrix2d rest_metric = metricOf(rest);
  if (!(rest_metric.determinant() > 0.0)) return 1.0;
  const Eigen::Matrix2d change = rest_metric.inverse() * metricOf(now);
  const double mean = 0.5 * change.trace();
  return std::sqrt(mean + std::sqrt(std::max(mean * mean - change.determinant(), 0.0)));
}

}  // namespace

std::vector<double> surfaceStrains(const TissueSurface& surface,
                                   const std::vector<Vec3>& vertices) {
  std::vector<double> strains(surface.rest.size(), 0.0), areas(surface.rest.size(), 0.0);
  for (const MeshTriangle& triangle : surface.triangles) {
    const double area = doubleArea(surface.rest, triangle).norm();
    const double strain =
        greatestStretch(cornersThere(surface.rest, triangle), cornersThere(vertices, triangle)) -
        1.0;
    for (const int vertex : triangle) {
      strains[at(vertex)] += area * strain;
      areas[at(vertex)] += area;
    }
  }
  for (std::size_t vertex = 0; vertex < strains.size(); ++vertex) {
    if (areas[vertex] > 0.0) strains[vertex] /= areas[vertex];
  }
  return strains;
}

}  // namespace robot_tissue
