#include "triangle_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tuning.h"

namespace robot_tissue {
namespace {

// The ray's direction is (kRayX, kRayY, 1), along no edge, face or diagonal of a lattice.
constexpr double kRayX = 0.41421356;
constexpr double kRayY = 0.23606798;
constexpr double kRaySlack = 1e-9;  // of the ray's parameter (m), for rounding

double squaredDistance(const TriangleBvh::Node& node, const Vec3& point) {
  return (node.low - point).cwiseMax(point - node.high).cwiseMax(0.0).squaredNorm();
}

bool rayMeets(const TriangleBvh::Node& node, const Vec3& from) {
  double near = 0.0;
  double far = std::numeric_limits<double>::infinity();
  const double direction[3] = {kRayX, kRayY, 1.0};
  for (int k = 0; k < 3; ++k) {
    near = std::max(near, (node.low[k] - from[k]) / direction[k] - kRaySlack);
    far = std::min(far, (node.high[k] - from[k]) / direction[k] + kRaySlack);
  }
  return near <= far;
}

// A corner in the ray's frame: x and y across it (0, 0: on it), z the way along it.
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

// What the triangle adds to the crossings ahead on the ray: 1 where it leads out of the surface, -1
// where it leads in, 0 where the ray misses it or met it before its start.
int crossingOf(const MeshTriangle& triangle, const Corners& corners, const Vec3& from) {
  const auto& [va, vb, vc] = triangle;
  const Vec3 a = sheared(corners[0], from), b = sheared(corners[1], from),
             c = sheared(corners[2], from);
  const double ab = spanned(va, a, vb, b), bc = spanned(vb, b, vc, c), ca = spanned(vc, c, va, a);
  const bool left = onLeft(va, vb, ab);
  if (onLeft(vb, vc, bc) != left || onLeft(vc, va, ca) != left) return 0;
  const double height = (bc * a.z() + ca * b.z() + ab * c.z()) * (left ? 1.0 : -1.0);
  if (!(height > 0.0)) return 0;
  return left ? 1 : -1;
}

}  // namespace

TriangleBvh::TriangleBvh(const std::vector<Vec3>& vertices,
                         const std::vector<MeshTriangle>& triangles)
    : triangles_(triangles), splitter_(vertices, triangles_) {
  if (triangles.empty()) return;
  findParts();
  std::vector<int> part_of_last(vertices.size(), -1);
  for (Part& part : parts_) addVertices(part, part_of_last);
  vertices_of_parts_.shrink_to_fit();
  vertices_.assign(vertices.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  moveTo(vertices);
}

// Splits nodes down to the parts' roots.
void TriangleBvh::findParts() {
  const int all = static_cast<int>(triangles_.size());
  const int most = std::max(tuning::kTrianglesOfPart, all / tuning::kParts);
  nodes_.resize(1);
  nodes_.front().triangles = all;
  std::vector<int> waiting = {0}, roots;
  while (!waiting.empty()) {
    const int number = waiting.back();
    waiting.pop_back();
    if (nodes_[at(number)].triangles <= most) {
      roots.push_back(number);
      continue;
    }
    const int first = static_cast<int>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    splitNode(number, first);
    above_.push_back(number);
    waiting.push_back(first + 1);
    waiting.push_back(first);
  }
  first_within_ = static_cast<int>(nodes_.size());
  part_at_.assign(at(first_within_), -1);
  for (const int root : roots) addPart(root);
}

void TriangleBvh::addPart(int root) {
  Node& node = nodes_[at(root)];
  Part part;
  part.root = root;
  part.is_split = node.triangles == 1;
  // Of one to be split: that it is no leaf.
  node.first_child = part.is_split ? -1 - splitter_.triangleAt(node.first_triangle) : 0;
  part_at_[at(root)] = static_cast<int>(parts_.size());
  parts_.push_back(part);
}

void TriangleBvh::addVertices(Part& part, std::vector<int>& part_of_last) {
  part.first_vertex = static_cast<int>(vertices_of_parts_.size());
  const Node& root = nodes_[at(part.root)];
  for (int place = root.first_triangle; place < root.first_triangle + root.triangles; ++place) {
    for (const int vertex : triangles_[at(splitter_.triangleAt(place))]) {
      if (std::exchange(part_of_last[at(vertex)], part.root) == part.root) continue;
      vertices_of_parts_.push_back(vertex);
    }
  }
  part.end_vertex = static_cast<int>(vertices_of_parts_.size());
}

void TriangleBvh::splitNode(int number, int first_child) const {
  Node& node = nodes_[at(number)];
  node.first_child = first_child;
  const int of_first = splitter_.split(node.first_triangle, node.triangles);
  const std::array<int, 2> counts = {of_first, node.triangles - of_first};
  for (const int second : {0, 1}) {
    Node& child = nodes_[at(first_child + second)];
    child.first_triangle = node.first_triangle + second * of_first;
    child.triangles = counts[at(second)];
    child.first_child = -1 - splitter_.triangleAt(child.first_triangle);  // until it is split
  }
}

void TriangleBvh::splitPart(Part& part) const {
  part.is_split = true;
  part.first = static_cast<int>(nodes_.size());
  part.end = part.first + 2 * (nodes_[at(part.root)].triangles - 1);
  // Tools come to few parts: that vectors double would be more than the nodes themselves.
  if (at(part.end) > nodes_.capacity()) nodes_.reserve(at(part.end) + nodes_.size() / 4);
  nodes_.resize(at(part.end));
  splitNode(part.root, part.first);
  int next = part.first + 2;
  for (int number = part.first; number < part.end; ++number) {
    if (nodes_[at(number)].triangles == 1) continue;
    splitNode(number, next);
    next += 2;
  }
}

void TriangleBvh::openPart(int number) const {
  Part& part = parts_[at(number)];
  if (!part.is_stale) return;
  if (!part.is_split) splitPart(part);
  refit(part);
  part.is_stale = false;
}

bool TriangleBvh::moveTo(const std::vector<Vec3>& vertices) {
  bool moved = false;
  for (Part& part : parts_) moved = movePart(part, vertices) || moved;
  vertices_ = vertices;
  if (!moved) return false;
  for (const Part& part : parts_) {
    if (isLeaf(nodes_[at(part.root)])) open(part.root);
  }
  for (std::size_t i = above_.size(); i-- > 0;) fit(above_[i]);
  return true;
}

bool TriangleBvh::movePart(Part& part, const std::vector<Vec3>& vertices) {
  VertexBounds bounds;
  bool is_same = true;
  for (int i = part.first_vertex; i < part.end_vertex; ++i) {
    const std::size_t vertex = at(vertices_of_parts_[at(i)]);
    const Vec3 &now = vertices[vertex], &before = vertices_[vertex];
    is_same &= (now.x() == before.x()) & (now.y() == before.y()) & (now.z() == before.z());
    bounds.add(now);
  }
  if (is_same) return false;
  Node& root = nodes_[at(part.root)];
  const Box box = bounds.box();
  root.low = box.min();
  root.high = box.max();
  part.is_stale = true;
  return true;
}

void TriangleBvh::refit(const Part& part) const {
  for (int number = part.end; number-- > part.first;) fit(number);
  fit(part.root);
}

// The node's box, around its triangle or around its children's boxes.
void TriangleBvh::fit(int number) const {
  Node& node = nodes_[at(number)];
  if (!isLeaf(node)) {
    const Node& left = nodes_[at(node.first_child)];
    const Node& right = nodes_[at(node.first_child + 1)];
    node.low = left.low.cwiseMin(right.low);
    node.high = left.high.cwiseMax(right.high);
    return;
  }
  const Corners here = corners(triangleOf(node));
  Box box;
  if ((here[0] + here[1] + here[2]).allFinite()) {
    for (const Vec3& corner : here) box.extend(corner);
  }
  node.low = box.min();
  node.high = box.max();
}

Box TriangleBvh::bounds() const {
  if (isEmpty()) return Box();
  return {nodes_.front().low, nodes_.front().high};
}

std::optional<TriangleBvh::Nearest> TriangleBvh::nearest(const Vec3& point, double reach,
                                                         double enough) const {
  if (isEmpty()) return std::nullopt;
  Search search{point, reach * reach, enough * enough, {}};
  // False for a point that is not finite: it has no nearest triangle.
  if (squaredDistance(nodes_.front(), point) < search.best) searchBelow(0, search);
  if (search.found.triangle < 0) return std::nullopt;
  search.found.distance = std::sqrt(search.best);
  return search.found;
}

// Looks into the nearer child first, so that the other can more often be left out.
void TriangleBvh::searchBelow(int number, Search& search) const {
  const Node& node = nodes_[at(number)];
  if (isLeaf(node)) return searchTriangle(triangleOf(node), search);
  open(number);  // `node` is no more
  int near = nodes_[at(number)].first_child, far = near + 1;
  double to_near = squaredDistance(nodes_[at(near)], search.point);
  double to_far = squaredDistance(nodes_[at(far)], search.point);
  if (to_far < to_near) {
    std::swap(near, far);
    std::swap(to_near, to_far);
  }
  if (to_near < search.best) searchBelow(near, search);
  if (to_far < search.best && search.best > search.enough) searchBelow(far, search);
}

void TriangleBvh::searchTriangle(int triangle, Search& search) const {
  const Corners here = corners(triangle);
  const Vec3 weights = nearestInTriangle(search.point, here);
  const Vec3 foot = pointOf(here, weights);
  const double squared = (search.point - foot).squaredNorm();
  if (!(squared < search.best)) return;
  search.best = squared;
  search.found.triangle = triangle;
  search.found.weights = weights;
  search.found.point = foot;
}

bool TriangleBvh::isInside(const Vec3& point) const {
  return !isEmpty() && crossingsBelow(0, point) > 0;
}

// Sum of crossingOf over the triangles below: how often the surface leads out along the ray, less
// how often in. Of a closed surface it is how often it goes around the point.
int TriangleBvh::crossingsBelow(int number, const Vec3& point) const {
  const Node& node = nodes_[at(number)];
  if (!rayMeets(node, point)) return 0;
  if (isLeaf(node)) {
    const int triangle = triangleOf(node);
    return crossingOf(triangles_[at(triangle)], corners(triangle), point);
  }
  open(number);  // `node` is no more
  const int first = nodes_[at(number)].first_child;
  return crossingsBelow(first, point) + crossingsBelow(first + 1, point);
}

}  // namespace robot_tissue
