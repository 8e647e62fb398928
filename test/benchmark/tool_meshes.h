// Meshes of tools, written where a scene or a study can load them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A closed surface of rings of points, around and down, as ASCII STL. Returns its address.
template <typename Vertex>
std::string writeRings(const std::string& name, int rings, int sides, Vertex vertex) {
  const char* folder = std::getenv("TMPDIR");
  const std::string path = std::string(folder ? folder : "/tmp") + "/robot_tissue_" + name + ".stl";
  std::ofstream stl(path);
  const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    if (a == b || b == c || c == a) return;
    stl << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& v : {a, b, c}) {
      stl << "vertex " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    }
    stl << "endloop\nendfacet\n";
  };
  stl.precision(9);
  stl << "solid " << name << "\n";
  for (int ring = 0; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side) {
      const Vec3 a = vertex(ring, side), b = vertex(ring + 1, side), c = vertex(ring + 1, side + 1),
                 d = vertex(ring, side + 1);
      facet(a, b, c);
      facet(a, c, d);
    }
  }
  stl << "endsolid " << name << "\n";
  return "file://" + path;
}

// An ellipsoid of 2,000 triangles about the origin.
inline std::string writeEllipsoid(const Vec3& semi_axes) {
  constexpr int kMeshSides = 40, kRings = 25;
  return writeRings("ellipsoid", kRings, kMeshSides, [&](int ring, int side) -> Vec3 {
    const double down = M_PI * ring / kRings, round = 2.0 * M_PI * (side % kMeshSides) / kMeshSides;
    if (ring == 0 || ring == kRings) return {0.0, 0.0, ring == 0 ? semi_axes.z() : -semi_axes.z()};
    const Vec3 unit(std::sin(down) * std::cos(round), std::sin(down) * std::sin(round),
                    std::cos(down));
    return semi_axes.cwiseProduct(unit);
  });
}

// A torus of 3,200 triangles that stands upright, about the origin: radii of its middle line and of
// its tube (m).
inline std::string writeRing(double radius, double tube) {
  constexpr int kMeshSides = 25, kRings = 64;
  return writeRings("ring", kRings, kMeshSides, [&](int ring, int side) -> Vec3 {
    const double along = 2.0 * M_PI * (ring % kRings) / kRings;
    const double round = 2.0 * M_PI * (side % kMeshSides) / kMeshSides;
    const double out = radius + tube * std::cos(round);
    return {out * std::cos(along), tube * std::sin(round), out * std::sin(along)};
  });
}

// A finger of 3,000 triangles: a capsule with bumps that stands upright, its tip at the origin;
// radius and length (m). As scripts/studies/hand.py makes it.
inline std::string writeFinger(double radius, double length) {
  constexpr int kMeshSides = 50, kRings = 31;
  constexpr double kBump = 0.04, kWave = 400.0;  // of the radius, 1; 1/m
  return writeRings("finger", kRings, kMeshSides, [&](int ring, int side) -> Vec3 {
    if (ring == 0 || ring == kRings) return {0.0, 0.0, ring == 0 ? length : 0.0};
    const double straight = length - 2.0 * radius;
    const double way = (M_PI * radius + straight) * (kRings - ring) / kRings;
    const double along = std::min(std::max(way - 0.5 * M_PI * radius, 0.0), straight);
    const double bend = (way - along) / radius,
                 round = 2.0 * M_PI * (side % kMeshSides) / kMeshSides;
    const double bump = 1.0 + kBump * std::cos(5.0 * round) * std::cos(kWave * way);
    const double out = radius * std::sin(bend) * bump;
    return {out * std::cos(round), out * std::sin(round), radius * (1.0 - std::cos(bend)) + along};
  });
}

}  // namespace robot_tissue
