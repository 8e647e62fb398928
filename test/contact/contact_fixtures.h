// Surfaces, shapes and mesh files that the contact tests share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {

struct Sheet {
  TissueSurface surface;
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

// The closed surface of a block with its top at z = 0, outside outwards.
inline Sheet makeBlock(const Eigen::Vector3i& cells, double spacing) {
  Sheet sheet;
  std::map<std::array<int, 3>, int> numbers;
  const auto vertex = [&](const Eigen::Vector3i& at_node) {
    const auto [known, is_new] = numbers.try_emplace({at_node.x(), at_node.y(), at_node.z()},
                                                     static_cast<int>(sheet.vertices.size()));
    if (is_new) sheet.addVertex(spacing * Vec3(at_node.x(), at_node.y(), at_node.z() - cells.z()));
    return known->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {0, cells[axis]}) {
      for (int i = 0; i < cells[u]; ++i) {
        for (int j = 0; j < cells[v]; ++j) {
          std::array<int, 4> quad;
          for (int k = 0; k < 4; ++k) {
            Eigen::Vector3i node;
            node[axis] = side;
            node[u] = i + (k == 1 || k == 2 ? 1 : 0);
            node[v] = j + (k >= 2 ? 1 : 0);
            quad[static_cast<std::size_t>(k)] = vertex(node);
          }
          if (side == 0) std::swap(quad[1], quad[3]);
          sheet.addTriangle(quad[0], quad[1], quad[2]);
          sheet.addTriangle(quad[0], quad[2], quad[3]);
        }
      }
    }
  }
  return sheet;
}

inline Sheet makeTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  Sheet sheet;
  for (const Vec3& corner : {a, b, c}) sheet.addVertex(corner);
  sheet.addTriangle(0, 1, 2);
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

inline ToolShape plane() {
  ToolShape shape;
  shape.type = ToolShape::Type::kPlane;
  return shape;
}

inline ToolShape placedAt(const Pose& pose, ToolShape shape) {
  shape.pose = pose;
  return shape;
}

inline ToolGeometry makeTool(std::vector<ToolShape> shapes, double padding = 0.0) {
  ToolGeometry tool;
  tool.name = "probe";
  for (ToolShape& shape : shapes) shape.padding += padding;
  tool.links = {{"tip", std::move(shapes)}};
  return tool;
}

inline Pose makePose(const Vec3& position, double angle = 0.0, const Vec3& axis = Vec3::UnitZ()) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = position;
  return pose;
}

inline RobotPose at(const Pose& pose) {
  RobotPose robot;
  robot.links = {pose};
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

// A closed ball of 2 rings x 2 rings - 2 bands of triangles; its corners are on the sphere.
inline std::vector<Triangle> ballTriangles(int rings, double radius) {
  std::vector<Triangle> triangles;
  const auto point = [&](int ring, int step) -> Vec3 {
    const double polar = M_PI * ring / rings;
    const double azimuth = M_PI * step / rings;
    return radius * Vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                         std::cos(polar));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) triangles.push_back({{point(i, j), point(i + 1, j), point(i, j + 1)}});
      if (i + 1 < rings) {
        triangles.push_back({{point(i, j + 1), point(i + 1, j), point(i + 1, j + 1)}});
      }
    }
  }
  return triangles;
}

// Closed around the z-axis: its outline from bottom to top, (distance from the axis, height), whose
// ends are on the axis.
inline std::vector<Triangle> revolvedTriangles(const std::vector<Eigen::Vector2d>& outline,
                                               int segments) {
  const auto point = [&](std::size_t ring, int segment) {
    const double angle = 2.0 * M_PI * (segment % segments) / segments;
    const double off = outline[ring].x();
    return Vec3(off * std::cos(angle), off * std::sin(angle), outline[ring].y());
  };
  std::vector<Triangle> triangles;
  for (std::size_t ring = 0; ring + 1 < outline.size(); ++ring) {
    for (int k = 0; k < segments; ++k) {
      const Vec3 a = point(ring, k), b = point(ring, k + 1);
      const Vec3 c = point(ring + 1, k + 1), d = point(ring + 1, k);
      if (ring > 0) triangles.push_back({{a, b, c}});
      if (ring + 2 < outline.size()) triangles.push_back({{a, c, d}});
    }
  }
  return triangles;
}

// A quarter of a circle from the axis on, its center so high on the axis: the end of a rod.
inline std::vector<Eigen::Vector2d> roundEnd(double radius, double center, int steps) {
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 0.5 * M_PI * i / steps;
    outline.emplace_back(radius * std::sin(angle), center - radius * std::cos(angle));
  }
  return outline;
}

// A prism: an outline in the x-z plane, counter-clockwise seen from -y, drawn out along y; `caps`
// divides the outline into triangles of its corners.
inline std::vector<Triangle> prismTriangles(const std::vector<Eigen::Vector2d>& outline,
                                            const std::vector<std::array<int, 3>>& caps,
                                            double width) {
  const auto corner = [&](std::size_t i, double y) {
    return Vec3(outline[i].x(), y, outline[i].y());
  };
  const double y = 0.5 * width;
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t next = (i + 1) % outline.size();
    triangles.push_back({{corner(i, -y), corner(i, y), corner(next, y)}});
    triangles.push_back({{corner(i, -y), corner(next, y), corner(next, -y)}});
  }
  for (const auto& cap : caps) {
    const auto a = static_cast<std::size_t>(cap[0]), b = static_cast<std::size_t>(cap[1]),
               c = static_cast<std::size_t>(cap[2]);
    triangles.push_back({{corner(a, -y), corner(b, -y), corner(c, -y)}});
    triangles.push_back({{corner(a, y), corner(c, y), corner(b, y)}});
  }
  return triangles;
}

// Two prongs that point to -z, joined above; `prong` wide, `notch` apart, `height` long.
inline std::vector<Triangle> forkTriangles(double prong, double notch, double height,
                                           double width) {
  const double x = 0.5 * notch, out = 0.5 * notch + prong, top = height + prong;
  const std::vector<Eigen::Vector2d> outline = {
      {-out, 0.0}, {-x, 0.0},     {-x, height}, {x, height}, {x, 0.0},
      {out, 0.0},  {out, height}, {out, top},   {-out, top}, {-out, height}};
  return prismTriangles(outline,
                        {{{0, 1, 2}},
                         {{0, 2, 9}},
                         {{4, 5, 6}},
                         {{4, 6, 3}},
                         {{9, 2, 8}},
                         {{2, 3, 8}},
                         {{3, 7, 8}},
                         {{3, 6, 7}}},
                        width);
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
