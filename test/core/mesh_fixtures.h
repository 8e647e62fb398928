// Closed meshes that the tests share.
#pragma once

#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// 12 triangles.
inline TriangleMesh boxMesh(const Vec3& min, const Vec3& max) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back(corner & 1 ? max.x() : min.x(), corner & 2 ? max.y() : min.y(),
                               corner & 4 ? max.z() : min.z());
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

// A refined octahedron with its vertices on a sphere: 8 * 4^rounds triangles.
inline TriangleMesh sphereMesh(double radius, int rounds) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), 0);
      if (is_new) {
        place->second = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back((mesh.vertices[at(a)] + mesh.vertices[at(b)]).normalized());
      }
      return place->second;
    };
    const auto whole = std::move(mesh.triangles);
    mesh.triangles.clear();
    for (const auto& [a, b, c] : whole) {
      const int ab = middle(a, b);
      const int bc = middle(b, c);
      const int ca = middle(c, a);
      for (const MeshTriangle& part :
           {MeshTriangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
        mesh.triangles.push_back(part);
      }
    }
  }
  for (Vec3& vertex : mesh.vertices) vertex *= radius;
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& vertex : mesh.vertices) vertex = pose * vertex;
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& offset) {
  return moved(std::move(mesh), Pose(Eigen::Translation3d(offset)));
}

inline TriangleMesh insideOut(TriangleMesh mesh) {
  for (MeshTriangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

inline TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
  const int shift = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) {
    mesh.triangles.push_back({a + shift, b + shift, c + shift});
  }
  return mesh;
}

// Each triangle with corners of its own, as STL has them.
inline TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh loose;
  for (const MeshTriangle& triangle : mesh.triangles) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const int corner : triangle) loose.vertices.push_back(mesh.vertices[at(corner)]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  return loose;
}

inline double volumeOf(const TriangleMesh& mesh) {
  return enclosedVolume(mesh.vertices, mesh.triangles);
}

// The same numbers on every machine.
class Random {
 public:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  Vec3 offset(double size) {
    const double x = between(-size, size);
    const double y = between(-size, size);
    return Vec3(x, y, between(-size, size));
  }
  Pose pose(double size) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(between(0.0, 3.0), offset(1.0).normalized()).matrix();
    pose.translation() = offset(size);
    return pose;
  }

 private:
  std::mt19937 engine_{1};
};

}  // namespace robot_tissue
