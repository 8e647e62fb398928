#include "triangle_splitter.h"

#include <numeric>
#include <utility>

namespace robot_tissue {
namespace {

Eigen::Index longestAxis(const Vec3& size) {
  if (size.x() >= size.y() && size.x() >= size.z()) return 0;
  return size.y() >= size.x() && size.y() >= size.z() ? 1 : 2;
}

}  // namespace

TriangleSplitter::TriangleSplitter(const std::vector<Vec3>& vertices,
                                   const std::vector<MeshTriangle>& triangles)
    : vertices_(vertices), triangles_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
}

Box TriangleSplitter::boundsOf(int first, int count) const {
  Box bounds;
  for (int place = first; place < first + count; ++place) {
    for (const int corner : triangles_[at(order_[at(place)])]) bounds.extend(vertices_[at(corner)]);
  }
  return bounds;
}

// Mean of its corners.
double TriangleSplitter::centerOf(int triangle, Eigen::Index axis) const {
  const auto& [i, j, k] = triangles_[at(triangle)];
  return (vertices_[at(i)][axis] + vertices_[at(j)][axis] + vertices_[at(k)][axis]) / 3.0;
}

int TriangleSplitter::split(int first, int count) {
  const Box bounds = boundsOf(first, count);
  const Eigen::Index axis = longestAxis(bounds.sizes());
  const double middle = 0.5 * (bounds.min()[axis] + bounds.max()[axis]);
  int end = first;  // of the first part
  for (int place = first; place < first + count; ++place) {
    if (centerOf(order_[at(place)], axis) > middle) continue;
    std::swap(order_[at(place)], order_[at(end)]);
    ++end;
  }
  const bool is_parted = end > first && end < first + count;
  return is_parted ? end - first : count / 2;
}

}  // namespace robot_tissue
