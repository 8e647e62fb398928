// Surfaces, shapes and mesh files that the contact tests share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {

struct Sheet {
  Surface surface;
  std::vector<Vec3> vertices;

  void addVertex(const Vec3& vertex) {
    surface.rest.push_back(vertex);
    vertices.push_back(vertex);
  }
  void addTriangle(int a, int b, int c) {
    surface.triangles.push_back({{a, b, c}});
    surface.opened.push_back(0);
  }
};

// cells x cells quads in the plane z = 0, outside above, from the origin.
inline Sheet makeSheet(int cells, double spacing) {
  Sheet sheet;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) sheet.addVertex(Vec3(i, j, 0.0) * spacing);
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int corner = i + j * (cells + 1);
      sheet.addTriangle(corner, corner + 1, corner + cells + 2);
      sheet.addTriangle(corner, corner + cells + 2, corner + cells + 1);
    }
  }
  return sheet;
}

// Triangles without extent: contacts at these points and nowhere else.
inline Sheet makePoints(const std::vector<Vec3>& points) {
  Sheet sheet;
  for (const Vec3& point : points) {
    const int vertex = static_cast<int>(sheet.vertices.size());
    sheet.addVertex(point);
    sheet.addTriangle(vertex, vertex, vertex);
  }
  return sheet;
}

inline ToolShape sphere(double radius) {
  ToolShape shape;
  shape.type = ToolShape::Type::kSphere;
  shape.radius = radius;
  return shape;
}

inline ToolShape box(const Vec3& size) {
  ToolShape shape;
  shape.type = ToolShape::Type::kBox;
  shape.size = size;
  return shape;
}

inline ToolShape cylinder(double radius, double length) {
  ToolShape shape;
  shape.type = ToolShape::Type::kCylinder;
  shape.radius = radius;
  shape.length = length;
  return shape;
}

inline ToolShape mesh(const std::string& resource) {
  ToolShape shape;
  shape.type = ToolShape::Type::kMesh;
  shape.resource = resource;
  return shape;
}

inline ToolGeometry makeTool(const std::vector<ToolShape>& shapes, double padding = 0.0) {
  return {"probe", "tip", padding, shapes};
}

inline Pose makePose(const Vec3& position, double angle = 0.0, const Vec3& axis = Vec3::UnitZ()) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = position;
  return pose;
}

inline RobotPose at(const Pose& pose) {
  RobotPose robot;
  robot.tools = {pose};
  return robot;
}

using Triangle = std::array<Vec3, 3>;

// The twelve triangles of a box about `center`.
inline std::vector<Triangle> boxTriangles(const Vec3& size, const Vec3& center = Vec3::Zero()) {
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const auto corner = [&](int i) -> Vec3 {
    const Vec3 sides((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                     (i & 4) != 0 ? 0.5 : -0.5);
    return center + sides.cwiseProduct(size);
  };
  std::vector<Triangle> triangles;
  for (const auto& quad : quads) {
    triangles.push_back({{corner(quad[0]), corner(quad[1]), corner(quad[2])}});
    triangles.push_back({{corner(quad[0]), corner(quad[2]), corner(quad[3])}});
  }
  return triangles;
}

// Writes an ASCII STL to the tests' temporary directory; returns its file:// address.
inline std::string writeStl(const std::string& name, const std::vector<Triangle>& triangles) {
  const std::string path = testing::TempDir() + "robot_tissue_" + name;
  std::ofstream file(path);
  file.precision(9);
  file << "solid test\n";
  for (const Triangle& triangle : triangles) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& v : triangle)
      file << "vertex " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    file << "endloop\nendfacet\n";
  }
  file << "endsolid test\n";
  return "file://" + path;
}

// Signed distances to shapes in their own frame, negative inside (m).
inline double boxDistance(const Vec3& size, const Vec3& p) {
  const Vec3 q = p.cwiseAbs() - 0.5 * size;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

inline double cylinderDistance(double radius, double length, const Vec3& p) {
  const Eigen::Vector2d q(p.head<2>().norm() - radius, std::abs(p.z()) - 0.5 * length);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

// Points in and around a box of half widths `reach` about the origin, the origin among them.
inline std::vector<Vec3> grid(const Vec3& reach) {
  std::vector<Vec3> points;
  const int n = 8;
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      for (int k = -n; k <= n; ++k) points.push_back(Vec3(i, j, k).cwiseProduct(reach) / n);
    }
  }
  return points;
}

template <typename Call>
std::string inputErrorOf(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace robot_tissue
