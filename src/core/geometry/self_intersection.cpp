#include <algorithm>
#include <utility>

#include "geometry/exact_points.h"
#include "robot_tissue/core/mesh_checks.h"

namespace robot_tissue {
namespace {

using ExactTriangle = std::array<ExactPoint, 3>;

bool hasArea(const ExactTriangle& t) {
  const auto area = areaVector(t[0], t[1], t[2]);
  return std::any_of(area.begin(), area.end(), [](Wide component) { return component != 0; });
}

// Two axes onto which a triangle with area keeps one.
std::array<std::size_t, 2> planeAxes(const ExactTriangle& t) {
  const auto area = areaVector(t[0], t[1], t[2]);
  const std::size_t axis = area[0] != 0 ? 0 : area[1] != 0 ? 1 : 2;
  return {(axis + 1) % 3, (axis + 2) % 3};
}

// Closed segments p-q and a-b in one plane, seen along the axes u and v.
bool segmentsMeet(const ExactPoint& p, const ExactPoint& q, const ExactPoint& a,
                  const ExactPoint& b, std::size_t u, std::size_t v) {
  const int to_a = turn(p, q, a, u, v);
  const int to_b = turn(p, q, b, u, v);
  if (to_a == 0 && to_b == 0) {  // on one line
    const std::size_t axis = p[u] != q[u] || a[u] != b[u] ? u : v;
    return std::max(p[axis], q[axis]) >= std::min(a[axis], b[axis]) &&
           std::max(a[axis], b[axis]) >= std::min(p[axis], q[axis]);
  }
  return to_a * to_b <= 0 && turn(a, b, p, u, v) * turn(a, b, q, u, v) <= 0;
}

bool meetsInPlane(const ExactPoint& p, const ExactPoint& q, const ExactTriangle& t) {
  const auto [u, v] = planeAxes(t);
  std::array<int, 3> turns{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (segmentsMeet(p, q, t[i], t[next], u, v)) return true;
    turns[i] = turn(t[i], t[next], p, u, v);
  }
  return turns[0] == turns[1] && turns[1] == turns[2];  // p is inside
}

// Closed segment and closed triangle.
bool meets(const ExactPoint& p, const ExactPoint& q, const ExactTriangle& t) {
  const int p_side = side(t[0], t[1], t[2], p);
  const int q_side = side(t[0], t[1], t[2], q);
  if (p_side == 0 && q_side == 0) return meetsInPlane(p, q, t);
  if (p_side == q_side) return false;
  const int first = side(p, q, t[0], t[1]);
  const int second = side(p, q, t[1], t[2]);
  const int third = side(p, q, t[2], t[0]);
  return (first >= 0 && second >= 0 && third >= 0) || (first <= 0 && second <= 0 && third <= 0);
}

class IntersectionTest {
 public:
  explicit IntersectionTest(const TriangleMesh& mesh)
      : triangles_(mesh.triangles), points_(exactPoints(mesh.vertices)) {}

  ExactTriangle corners(int triangle) const {
    const MeshTriangle& t = triangles_[at(triangle)];
    return {points_[at(t[0])], points_[at(t[1])], points_[at(t[2])]};
  }

  // Both triangles have area.
  bool intersect(int one, int other) const {
    std::array<bool, 3> shared_one{};  // per corner
    std::array<bool, 3> shared_other{};
    int shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (triangles_[at(one)][i] != triangles_[at(other)][j]) continue;
        shared_one[i] = shared_other[j] = true;
        ++shared;
      }
    }
    if (shared == 3) return true;
    if (shared == 2) return fold(corners(one), shared_one, corners(other), shared_other);
    return anyEdgeMeets(corners(one), shared_one, corners(other)) ||
           anyEdgeMeets(corners(other), shared_other, corners(one));
  }

 private:
  // Of the edges without a shared corner.
  static bool anyEdgeMeets(const ExactTriangle& one, const std::array<bool, 3>& shared,
                           const ExactTriangle& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      if (!shared[i] && !shared[next] && meets(one[i], one[next], other)) return true;
    }
    return false;
  }

  // Neighbors over an edge that lie on each other.
  static bool fold(const ExactTriangle& one, const std::array<bool, 3>& shared_one,
                   const ExactTriangle& other, const std::array<bool, 3>& shared_other) {
    const auto tipOf = [](const std::array<bool, 3>& shared) -> std::size_t {
      return !shared[0] ? 0 : !shared[1] ? 1 : 2;
    };
    const std::size_t tip = tipOf(shared_one);
    const ExactPoint& a = one[(tip + 1) % 3];
    const ExactPoint& b = one[(tip + 2) % 3];
    const ExactPoint& opposite = other[tipOf(shared_other)];
    if (side(one[0], one[1], one[2], opposite) != 0) return false;
    const auto [u, v] = planeAxes(one);
    return turn(a, b, one[tip], u, v) == turn(a, b, opposite, u, v);
  }

  const std::vector<MeshTriangle>& triangles_;
  std::vector<ExactPoint> points_;
};

struct Bounds {
  ExactPoint min;
  ExactPoint max;

  explicit Bounds(const ExactTriangle& t) : min(t[0]), max(t[0]) {
    for (const ExactPoint& corner : {t[1], t[2]}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        min[axis] = std::min(min[axis], corner[axis]);
        max[axis] = std::max(max[axis], corner[axis]);
      }
    }
  }
  void add(const Bounds& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      min[axis] = std::min(min[axis], other.min[axis]);
      max[axis] = std::max(max[axis], other.max[axis]);
    }
  }
  bool overlaps(const Bounds& other) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (min[axis] > other.max[axis] || other.min[axis] > max[axis]) return false;
    }
    return true;
  }
};

// The triangles' boxes, halved again and again along the longest side of what holds them.
class AabbTree {
 public:
  struct Item {
    Bounds bounds;
    int triangle = 0;
  };

  explicit AabbTree(std::vector<Item> items) : items_(std::move(items)) {
    if (!items_.empty()) build(0, static_cast<int>(items_.size()));
  }

  // Calls visit(one, other) for every pair of triangles whose boxes overlap, once.
  template <typename Visit>
  void visitPairs(const Visit& visit) const {
    for (const Node& node : nodes_) {
      if (node.left >= 0) visitBetween(nodes_[at(node.left)], nodes_[at(node.right)], visit);
    }
  }

 private:
  struct Node {
    Bounds bounds;
    int item = -1;  // of a leaf
    int left = -1;
    int right = -1;
    int count = 1;  // of items
  };

  int build(int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.push_back({items_[at(begin)].bounds, begin, -1, -1, end - begin});
    if (end - begin == 1) return index;
    Bounds bounds = items_[at(begin)].bounds;
    for (int i = begin; i < end; ++i) bounds.add(items_[at(i)].bounds);
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other) {
      if (bounds.max[other] - bounds.min[other] > bounds.max[axis] - bounds.min[axis]) axis = other;
    }
    const int middle = (begin + end) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [axis](const Item& a, const Item& b) {
                       return a.bounds.min[axis] + a.bounds.max[axis] <
                              b.bounds.min[axis] + b.bounds.max[axis];
                     });
    const int left = build(begin, middle);
    const int right = build(middle, end);
    nodes_[at(index)] = {bounds, -1, left, right, end - begin};
    return index;
  }

  template <typename Visit>
  void visitBetween(const Node& one, const Node& other, const Visit& visit) const {
    if (!one.bounds.overlaps(other.bounds)) return;
    if (one.count == 1 && other.count == 1) {
      visit(items_[at(one.item)].triangle, items_[at(other.item)].triangle);
      return;
    }
    const Node& larger = one.count >= other.count ? one : other;
    const Node& smaller = one.count >= other.count ? other : one;
    visitBetween(nodes_[at(larger.left)], smaller, visit);
    visitBetween(nodes_[at(larger.right)], smaller, visit);
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<std::pair<int, int>> intersectingTriangles(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> pairs;
  if (mesh.triangles.empty()) return pairs;
  const IntersectionTest test(mesh);
  std::vector<AabbTree::Item> items;
  for (int triangle = 0; triangle < static_cast<int>(mesh.triangles.size()); ++triangle) {
    const ExactTriangle corners = test.corners(triangle);
    if (hasArea(corners)) items.push_back({Bounds(corners), triangle});
  }
  AabbTree(std::move(items)).visitPairs([&](int one, int other) {
    if (test.intersect(one, other)) pairs.push_back(std::minmax({one, other}));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace robot_tissue
