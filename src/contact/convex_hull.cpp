#include "convex_hull.h"

#include <geometric_shapes/bodies.h>
#include <geometric_shapes/mesh_operations.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/mesh/quiet_console.h"
#include "triangle_samples.h"

namespace robot_tissue {
namespace {

// A hull with less volume than this share of its extent cubed counts as flat.
constexpr double kFlatShare = 1e-9;
// Nearer to a face than this (m), the direction to its nearest point is rounding noise.
constexpr double kOnFace = 1e-12;

TriangleMesh loadMesh(const std::string& resource, const Vec3& scale, const std::string& owner) {
  try {
    return loadMeshFile(resource, scale);
  } catch (const InputError& error) {
    throw InputError(owner + ": mesh '" + resource + "' " + error.what() +
                     "; allowed is a package:// or file:// address of a mesh with volume");
  }
}

std::unique_ptr<shapes::Mesh> toShape(const TriangleMesh& mesh) {
  const EigenSTL::vector_Vector3d vertices(mesh.vertices.begin(), mesh.vertices.end());
  std::vector<unsigned int> corners;
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (const int corner : triangle) corners.push_back(static_cast<unsigned int>(corner));
  }
  return std::unique_ptr<shapes::Mesh>(shapes::createMeshFromVertices(vertices, corners));
}

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

// Adds the face turned outward; leaves out one without area, which has no normal.
void addFace(std::array<int, 3> corners, const Vec3& middle, ConvexHull& hull) {
  const auto at = [&](std::size_t k) {
    return hull.vertices[static_cast<std::size_t>(corners[k])];
  };
  Vec3 area = (at(1) - at(0)).cross(at(2) - at(0));
  double six_volumes = area.dot(at(0) - middle);
  if (six_volumes < 0.0) {
    std::swap(corners[1], corners[2]);
    area = -area;
    six_volumes = -six_volumes;
  }
  if (!(area.norm() > 0.0)) return;
  HullFace face;
  face.vertices = corners;
  face.normal = area.normalized();
  face.offset_m = face.normal.dot(at(0));
  hull.faces.push_back(face);
  hull.volume += six_volumes / 6.0;
}

}  // namespace

ConvexHull loadHull(const std::string& resource, const Vec3& scale, const std::string& owner) {
  const TriangleMesh mesh = loadMesh(resource, scale, owner);
  ConvexHull hull;
  double extent = 0.0;
  {
    QuietConsole console;
    const bodies::ConvexMesh body(toShape(mesh).get());
    if (!body.getTriangles().empty()) {
      hull.vertices.assign(body.getVertices().begin(), body.getVertices().end());
      const Vec3 middle = mean(hull.vertices);
      const auto& corners = body.getTriangles();
      for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
        addFace({static_cast<int>(corners[t]), static_cast<int>(corners[t + 1]),
                 static_cast<int>(corners[t + 2])},
                middle, hull);
      }
      for (const Vec3& vertex : hull.vertices) {
        extent = std::max(extent, 2.0 * (vertex - middle).norm());
      }
      hull.mesh_volume = std::abs(enclosedVolume(mesh.vertices, mesh.triangles));
    }
  }
  if (!(hull.volume > kFlatShare * extent * extent * extent)) {
    throw InputError(owner + ": mesh '" + resource +
                     "' has no volume; allowed is a mesh that is not flat");
  }
  return hull;
}

std::optional<WayOut> ConvexHull::wayOut(const Vec3& point, double padding) const {
  const HullFace* nearest = nullptr;
  double height = -std::numeric_limits<double>::infinity();
  for (const HullFace& face : faces) {
    const double above = face.normal.dot(point) - face.offset_m;
    if (above <= height) continue;
    height = above;
    nearest = &face;
    if (height >= padding) return std::nullopt;
  }
  if (nearest == nullptr) return std::nullopt;
  if (height <= kOnFace) return WayOut{padding - height, nearest->normal};

  // Outside the hull, within the padding: the way out is from the nearest point of its faces.
  WayOut out;
  for (const HullFace& face : faces) {
    const auto corner = [&](std::size_t k) {
      return vertices[static_cast<std::size_t>(face.vertices[k])];
    };
    const Vec3 a = corner(0), b = corner(1), c = corner(2);
    const Vec3 weights = nearestInTriangle(point, a, b, c);
    const Vec3 away = point - (weights[0] * a + weights[1] * b + weights[2] * c);
    const double depth = padding - away.norm();
    if (depth <= out.depth_m) continue;
    out.depth_m = depth;
    out.normal = away.normalized();
  }
  if (!(out.depth_m > 0.0)) return std::nullopt;
  return out;
}

double ConvexHull::thickness() const {
  double thinnest = std::numeric_limits<double>::infinity();
  for (const HullFace& face : faces) {
    double deepest = 0.0;
    for (const Vec3& vertex : vertices) {
      deepest = std::max(deepest, face.offset_m - face.normal.dot(vertex));
    }
    thinnest = std::min(thinnest, deepest);
  }
  return thinnest;
}

}  // namespace robot_tissue
