// Convex hull of a mesh: what a mesh tool touches with.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// How far a point is from leaving a shape, and which way.
struct WayOut {
  double depth_m = 0.0;        // > 0: inside the padded shape
  Vec3 normal = Vec3::Zero();  // unit, out of the shape; zero when every way is as good
};

struct HullFace {
  std::array<int, 3> vertices;  // counter-clockwise seen from outside
  Vec3 normal = Vec3::Zero();   // unit, outward
  double offset_m = 0.0;        // normal . x = offset on the face
};

struct ConvexHull {
  std::vector<Vec3> vertices;  // frame of the mesh, scaled (m)
  std::vector<HullFace> faces;
  double volume = 0.0;       // m^3
  double mesh_volume = 0.0;  // of the mesh itself, m^3

  // Exact on the faces; nothing when the point is out of the padded hull.
  std::optional<WayOut> wayOut(const Vec3& point, double padding) const;
  // Smallest width of the hull over its faces' normals (m).
  double thickness() const;
};

// `owner` begins the message. Throws InputError: mesh that cannot be loaded or has no volume.
ConvexHull loadHull(const std::string& resource, const Vec3& scale, const std::string& owner);

}  // namespace robot_tissue
