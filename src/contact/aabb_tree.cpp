#include "aabb_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_tissue {
namespace {

constexpr std::size_t kLeafSize = 4;
constexpr std::size_t kStackSize = 128;  // halving: far more than the depth of any tree
// Of the ray; along no edge or face of a lattice.
constexpr double kRayX = 0.41421356;
constexpr double kRayY = 0.23606798;
constexpr double kRaySlack = 1e-9;  // of the ray's parameter (m), for rounding

double squaredDistance(const Box& box, const Vec3& point) {
  return (box.min() - point).cwiseMax(point - box.max()).cwiseMax(0.0).squaredNorm();
}

bool rayMeets(const Box& box, const Vec3& from) {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();
  const double direction[3] = {kRayX, kRayY, 1.0};
  for (int k = 0; k < 3; ++k) {
    near = std::max(near, (box.min()[k] - from[k]) / direction[k] - kRaySlack);
    far = std::min(far, (box.max()[k] - from[k]) / direction[k] + kRaySlack);
  }
  return near <= far;
}

// A corner seen along the ray, from its start.
Vec3 sheared(const Vec3& corner, const Vec3& from) {
  const Vec3 d = corner - from;
  return {d.x() - kRayX * d.z(), d.y() - kRayY * d.z(), d.z()};
}

// Twice the area that the edge and the ray span: > 0 with the ray on the left. Computed alike for
// both triangles of an edge.
double spanned(int vertex_a, const Vec3& a, int vertex_b, const Vec3& b) {
  if (vertex_a < vertex_b) return a.x() * b.y() - a.y() * b.x();
  return -(b.x() * a.y() - b.y() * a.x());
}

bool onLeft(int vertex_a, int vertex_b, double area) {
  return area > 0.0 || (area == 0.0 && vertex_a < vertex_b);
}

}  // namespace

// Ericson, "Real-Time Collision Detection", section 5.1.5: Voronoi regions of the triangle.
Vec3 nearestInTriangle(const Vec3& p, const Corners& corners) {
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

AabbTree::AabbTree(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles) {
  std::vector<Unsorted> unsorted;
  unsorted.reserve(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const auto& [a, b, c] = triangles[k];
    unsorted.push_back({(vertices[at(a)] + vertices[at(b)] + vertices[at(c)]) / 3.0, k});
  }
  entries_.reserve(unsorted.size());
  nodes_.reserve(unsorted.size() + 1);
  build(0, unsorted.size(), triangles, unsorted);
  moveTo(vertices);
}

// Halves the triangles along the longest side of their centers' box; depth first.
void AabbTree::build(std::size_t first, std::size_t end, const std::vector<MeshTriangle>& triangles,
                     std::vector<Unsorted>& unsorted) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({Box(), 0, 0});
  if (end - first <= kLeafSize) {
    nodes_[node].first = static_cast<int>(entries_.size());
    nodes_[node].count = static_cast<int>(end - first);
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t triangle = unsorted[i].triangle;
      entries_.push_back({Corners(), triangles[triangle], static_cast<int>(triangle)});
    }
    return;
  }
  Box box;
  for (std::size_t i = first; i < end; ++i) box.extend(unsorted[i].center);
  int axis = 0;
  (box.max() - box.min()).maxCoeff(&axis);
  const std::size_t middle = first + (end - first) / 2;
  const auto place = [&](std::size_t i) {
    return unsorted.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(place(first), place(middle), place(end),
                   [axis](const Unsorted& a, const Unsorted& b) {
                     return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis]
                                                             : a.triangle < b.triangle;
                   });
  build(first, middle, triangles, unsorted);
  nodes_[node].first = static_cast<int>(nodes_.size());
  build(middle, end, triangles, unsorted);
}

// Children come after their parents.
void AabbTree::moveTo(const std::vector<Vec3>& vertices) {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    node.box.setEmpty();
    if (node.count == 0 && !entries_.empty()) {
      for (const std::size_t child : {i + 1, at(node.first)}) {
        node.box.extend(nodes_[child].box);
      }
      continue;
    }
    for (std::size_t k = at(node.first); k < at(node.first + node.count); ++k) {
      auto& [a, b, c] = entries_[k].corners;
      a = vertices[at(entries_[k].vertices[0])];
      b = vertices[at(entries_[k].vertices[1])];
      c = vertices[at(entries_[k].vertices[2])];
      if (!(a + b + c).allFinite()) continue;
      for (const Vec3& corner : {a, b, c}) node.box.extend(corner);
    }
  }
}

std::optional<AabbTree::Nearest> AabbTree::nearest(const Vec3& point, double reach,
                                                   double enough) const {
  struct Waiting {
    std::size_t node;
    double squared;
  };
  std::array<Waiting, kStackSize> stack;
  std::size_t waiting = 0;
  Nearest found;
  double best = reach * reach;
  // Written so that a point that is not finite has none.
  const double start = squaredDistance(nodes_.front().box, point);
  if (start < best) stack[waiting++] = {0, start};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.squared >= best) continue;
    const Node& node = nodes_[next.node];
    if (node.count == 0) {
      Waiting near{next.node + 1, squaredDistance(nodes_[next.node + 1].box, point)};
      Waiting far{at(node.first), squaredDistance(nodes_[at(node.first)].box, point)};
      if (far.squared < near.squared) std::swap(near, far);
      if (far.squared < best) stack[waiting++] = far;
      if (near.squared < best) stack[waiting++] = near;
      continue;
    }
    for (std::size_t i = at(node.first); i < at(node.first + node.count); ++i) {
      const Corners& corners = entries_[i].corners;
      const Vec3 weights = nearestInTriangle(point, corners);
      const Vec3 foot = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
      const double squared = (point - foot).squaredNorm();
      if (!(squared < best)) continue;
      best = squared;
      found.triangle = entries_[i].triangle;
      found.weights = weights;
      found.point = foot;
      if (squared <= enough * enough) waiting = 0;
    }
  }
  if (found.triangle < 0) return std::nullopt;
  found.distance = std::sqrt(best);
  return found;
}

bool AabbTree::isInside(const Vec3& point) const {
  std::array<std::size_t, kStackSize> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  int outwards = 0;
  while (waiting > 0) {
    const std::size_t next = stack[--waiting];
    const Node& node = nodes_[next];
    if (!rayMeets(node.box, point)) continue;
    if (node.count == 0 && !entries_.empty()) {
      stack[waiting++] = at(node.first);
      stack[waiting++] = next + 1;
      continue;
    }
    for (std::size_t i = at(node.first); i < at(node.first + node.count); ++i) {
      const auto& [va, vb, vc] = entries_[i].vertices;
      const Vec3 a = sheared(entries_[i].corners[0], point);
      const Vec3 b = sheared(entries_[i].corners[1], point);
      const Vec3 c = sheared(entries_[i].corners[2], point);
      const double ab = spanned(va, a, vb, b), bc = spanned(vb, b, vc, c),
                   ca = spanned(vc, c, va, a);
      const bool left = onLeft(va, vb, ab);
      if (onLeft(vb, vc, bc) != left || onLeft(vc, va, ca) != left) continue;
      const double height = (bc * a.z() + ca * b.z() + ab * c.z()) * (left ? 1.0 : -1.0);
      if (height > 0.0) outwards += left ? 1 : -1;
    }
  }
  return outwards > 0;
}

void AabbTree::collectNear(const Corners& corners, double margin,
                           std::vector<int>& triangles) const {
  const Vec3 reach = Vec3::Constant(margin);
  const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - reach;
  const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) + reach;
  const auto meets = [&](const Vec3& min, const Vec3& max) {
    return (min.array() <= high.array()).all() && (max.array() >= low.array()).all();
  };
  std::array<std::size_t, kStackSize> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const std::size_t next = stack[--waiting];
    const Node& node = nodes_[next];
    if (!meets(node.box.min(), node.box.max())) continue;
    if (node.count == 0 && !entries_.empty()) {
      stack[waiting++] = at(node.first);
      stack[waiting++] = next + 1;
      continue;
    }
    for (std::size_t i = at(node.first); i < at(node.first + node.count); ++i) {
      const auto& [a, b, c] = entries_[i].corners;
      if (!meets(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c))) continue;
      triangles.push_back(entries_[i].triangle);
    }
  }
}

}  // namespace robot_tissue
