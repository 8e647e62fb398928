#include "robot_tissue/core/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/tuning.h"
#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {
namespace {

// For each vertex the one that stands for it: the first of those near it. Sweeps along a slanting
// direction, as many vertices of a flat wall share a coordinate.
std::vector<int> representatives(const std::vector<Vec3>& vertices, double reach) {
  const Vec3 direction = Vec3(0.537, 0.611, 0.581).normalized();
  std::vector<double> along;
  for (const Vec3& vertex : vertices) along.push_back(direction.dot(vertex - vertices.front()));
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_pair(along[at(a)], a) < std::make_pair(along[at(b)], b);
  });
  DisjointSets sets(vertices.size());
  for (auto i = order.begin(); i != order.end(); ++i) {
    // Twice the reach: the places along the direction are rounded.
    for (auto j = i + 1; j != order.end() && along[at(*j)] - along[at(*i)] <= 2.0 * reach; ++j) {
      if ((vertices[at(*j)] - vertices[at(*i)]).norm() > reach) continue;
      sets.join(*i, *j);
    }
  }
  std::vector<int> stands;
  for (int vertex = 0; vertex < static_cast<int>(vertices.size()); ++vertex) {
    stands.push_back(sets.lowest(vertex));
  }
  return stands;
}

}  // namespace

Box boundsOf(const std::vector<Vec3>& vertices) {
  VertexBounds bounds;
  for (const Vec3& vertex : vertices) bounds.add(vertex);
  return bounds.box();
}

Vec3 doubleArea(const std::vector<Vec3>& vertices, const MeshTriangle& corners) {
  const Vec3& a = vertices[at(corners[0])];
  return (vertices[at(corners[1])] - a).cross(vertices[at(corners[2])] - a);
}

double enclosedVolume(const std::vector<Vec3>& vertices,
                      const std::vector<MeshTriangle>& triangles) {
  if (triangles.empty()) return 0.0;
  const Vec3& origin = vertices[at(triangles.front()[0])];  // near, so that little cancels
  double six_volumes = 0.0;
  for (const MeshTriangle& triangle : triangles) {
    const Vec3 a = vertices[at(triangle[0])] - origin;
    const Vec3 b = vertices[at(triangle[1])] - origin;
    const Vec3 c = vertices[at(triangle[2])] - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

bool encloses(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
              const Vec3& point) {
  double half_angles = 0.0;  // half of the solid angle, 2 pi inside
  for (const MeshTriangle& triangle : triangles) {
    const Vec3 a = vertices[at(triangle[0])] - point;
    const Vec3 b = vertices[at(triangle[1])] - point;
    const Vec3 c = vertices[at(triangle[2])] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles > M_PI;
}

TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh joined;
  if (mesh.vertices.empty()) return joined;
  const Box box = boundsOf(mesh.vertices);
  const auto stands =
      representatives(mesh.vertices, tuning::kWeld * (box.max() - box.min()).maxCoeff());
  std::vector<int> number(mesh.vertices.size(), -1);
  for (MeshTriangle triangle : mesh.triangles) {
    for (int& corner : triangle) corner = stands[at(corner)];
    const auto [a, b, c] = triangle;
    if (a == b || b == c || c == a) continue;
    for (int& corner : triangle) {
      int& known = number[at(corner)];
      if (known < 0) {
        known = static_cast<int>(joined.vertices.size());
        joined.vertices.push_back(mesh.vertices[at(corner)]);
      }
      corner = known;
    }
    joined.triangles.push_back(triangle);
  }
  return joined;
}

}  // namespace robot_tissue
