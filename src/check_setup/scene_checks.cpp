#include "scene_checks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kLargestOrgan = 10.0;    // m: whatever is larger was drawn in another unit. Chosen
constexpr double kSmallestOrgan = 0.002;  // m. Chosen
constexpr double kFewestCells = 2.0;      // across a wall that bends. Chosen
constexpr double kThinShare = 0.05;       // of the surface: less are edges that run out. Chosen
constexpr std::size_t kMostRays = 300;    // through a mesh

std::string percentText(double share) { return numberText(std::round(100.0 * share)) + " %"; }

// What scales the shape to a size of organs.
std::string scaleFor(double extent) {
  if (extent > kLargestOrgan) return extent > 1e3 * kLargestOrgan ? "1.0e-6" : "0.001";
  return "1000.0";
}

Vec3 scaleOf(const YAML::Node& scale) {
  if (!scale) return Vec3::Ones();
  if (scale.IsScalar()) return Vec3::Constant(scale.as<double>());
  const auto factors = scale.as<std::vector<double>>();
  return factors.size() == 3 ? Vec3(factors[0], factors[1], factors[2]) : Vec3::Ones();
}

Vec3 extentOf(const YAML::Node& shape, const std::string& folder) {
  if (shape["type"].as<std::string>() == "mesh") {
    const Entry resource(shape["resource"], "tissue.shape.resource", "");
    const Vec3 scale = scaleOf(shape["scale"]);
    return boundsOf(loadMeshFile(readResource(resource, folder), scale).vertices).sizes();
  }
  const auto low = shape["min"].as<std::vector<double>>();
  const auto high = shape["max"].as<std::vector<double>>();
  return {high.at(0) - low.at(0), high.at(1) - low.at(1), high.at(2) - low.at(2)};
}

// Distance along the ray (m); infinite where it misses. Moller and Trumbore 1997.
double hit(const Vec3& from, const Vec3& along, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kMisses = std::numeric_limits<double>::infinity();
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 across = along.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0.0) return kMisses;
  const Vec3 there = (from - a) / determinant;
  const double u = there.dot(across);
  const Vec3 turned = there.cross(ab);
  const double v = along.dot(turned);
  const double distance = ac.dot(turned);
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 ? distance : kMisses;
}

// From the middle of a triangle straight in to the next wall (m).
double thicknessAt(const TriangleMesh& mesh, std::size_t triangle) {
  const auto corner = [&](std::size_t of, std::size_t i) {
    return mesh.vertices[at(mesh.triangles[of][i])];
  };
  const Vec3 middle = (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0;
  const Vec3 inwards = -doubleArea(mesh.vertices, mesh.triangles[triangle]).normalized();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t other = 0; other < mesh.triangles.size(); ++other) {
    if (other == triangle) continue;
    const double here = hit(middle, inwards, corner(other, 0), corner(other, 1), corner(other, 2));
    nearest = std::min(nearest, here);
  }
  return nearest;
}

struct Walls {
  double thinnest = std::numeric_limits<double>::infinity();  // m, of those that are thin
  double thin_share = 0.0;                                    // of the area looked at
};

Walls wallsOf(const TriangleMesh& mesh, double thin) {
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kMostRays);
  Walls walls;
  double all = 0.0, thin_area = 0.0;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); triangle += stride) {
    const double area = doubleArea(mesh.vertices, mesh.triangles[triangle]).norm();
    const double thickness = thicknessAt(mesh, triangle);
    all += area;
    if (thickness >= thin) continue;
    thin_area += area;
    walls.thinnest = std::min(walls.thinnest, thickness);
  }
  if (all > 0.0) walls.thin_share = thin_area / all;
  return walls;
}

}  // namespace

Findings checkUnits(const YAML::Node& scene, const std::string& folder) {
  double extent = 0.0;
  try {
    extent = extentOf(scene["tissue"]["shape"], folder).maxCoeff();
  } catch (const std::exception&) {
    return {};  // the scene's own checks say what is wrong with it
  }
  if (extent >= kSmallestOrgan && extent <= kLargestOrgan) return {};
  const bool is_large = extent > kLargestOrgan;
  const std::string text = "tissue.shape: " + numberText(extent) + " m across, which looks like " +
                           (is_large ? "millimeters" : "a length scaled twice");
  const bool is_mesh = scene["tissue"]["shape"]["type"].as<std::string>() == "mesh";
  const std::string remedy =
      is_mesh ? "tissue.shape.scale: " + scaleFor(extent) + " times what it is now"
              : "give lengths in m";
  return {{Finding::Level::kWarning, text, remedy}};
}

Findings checkWalls(const TissueConfig& tissue) {
  const double thin = kFewestCells * tissue.spacing;
  Walls walls;
  if (tissue.mesh) {
    walls = wallsOf(*tissue.mesh, thin * (1.0 - 1e-9));
  } else {
    const double thickness = tissue.shape.sizes().minCoeff();
    if (thickness < thin * (1.0 - 1e-9)) walls = {thickness, 1.0};
  }
  if (walls.thin_share < kThinShare) return {};
  return {{Finding::Level::kWarning,
           "tissue.spacing: " + percentText(walls.thin_share) +
               " of the walls are thinner than two spacings, the thinnest " +
               numberText(1e3 * walls.thinnest) + " mm: they bend too stiffly",
           "tissue.spacing: " + numberText(walls.thinnest / kFewestCells) + " or less"}};
}

Findings checkForNode(const Scene& scene) {
  Findings findings;
  for (const ToolConfig& tool : scene.tools) {
    for (const ToolLink& link : tool.links) {
      if (!link.link.empty()) continue;
      findings.push_back({Finding::Level::kWarning,
                          "tools: '" + tool.name + "' names no link: only simulate runs it",
                          "link: a link of the robot's URDF"});
      break;
    }
  }
  if (scene.tissue.fixed.empty() && scene.supports.empty()) {
    findings.push_back({Finding::Level::kWarning,
                        "tissue.fixed: nothing holds the tissue: a tool pushes it away",
                        "tissue.fixed, or supports"});
  }
  return findings;
}

}  // namespace robot_tissue
