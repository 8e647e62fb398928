#include "scene_checks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kLargestOrgan = 10.0;    // m: whatever is larger was drawn in another unit. Chosen
constexpr double kSmallestOrgan = 0.002;  // m. Chosen
// Of a wall's stiffness in bending (1). One that lies along no plane of the grid bends by squares
// of the coordinates, which trilinear cells do not have: it is stiffer by kOblique sin(2 a)^4
// (h / t)^2, a its angle, t its thickness. The number is that of thin_walls (doc/accuracy.md).
constexpr double kOblique = 1.1;
constexpr double kTooStiff = 0.1;       // more is told. Chosen
constexpr double kThinShare = 0.05;     // of the surface: less are edges that run out. Chosen
constexpr std::size_t kMostRays = 300;  // through a mesh

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

// sin(2 a)^2 where the wall's normal lies in a plane of the grid.
double obliqueness(const Vec3& normal) {
  const Vec3 squares = normal.cwiseAbs2();
  return 4.0 * (squares[0] * squares[1] + squares[1] * squares[2] + squares[0] * squares[2]);
}

struct Walls {
  double thinnest = std::numeric_limits<double>::infinity();  // m, under a spacing
  double thin_share = 0.0;                                    // of the area looked at
  double stiff_share = 0.0;  // of walls that are too stiff as they are oblique
  double too_stiff = 0.0;    // the most of them (1)
  double stiffest = 0.0;     // m, thickness there
  double spacing = std::numeric_limits<double>::infinity();  // m, at which none would be
};

void lookAt(double thickness, const Vec3& normal, double area, double spacing, Walls& walls) {
  if (thickness < spacing * (1.0 + 1e-9)) {
    walls.thin_share += area;
    walls.thinnest = std::min(walls.thinnest, thickness);
  }
  const double oblique = obliqueness(normal);
  const double too_stiff = kOblique * std::pow(oblique * spacing / thickness, 2);
  if (!(too_stiff > kTooStiff)) return;
  walls.stiff_share += area;
  walls.spacing = std::min(walls.spacing, std::sqrt(kTooStiff / kOblique) * thickness / oblique);
  if (too_stiff <= walls.too_stiff) return;
  walls.too_stiff = too_stiff;
  walls.stiffest = thickness;
}

Walls wallsOf(const TriangleMesh& mesh, double spacing) {
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kMostRays);
  Walls walls;
  double all = 0.0;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); triangle += stride) {
    const Vec3 twice = doubleArea(mesh.vertices, mesh.triangles[triangle]);
    all += twice.norm();
    lookAt(thicknessAt(mesh, triangle), twice.normalized(), twice.norm(), spacing, walls);
  }
  for (double* share : {&walls.thin_share, &walls.stiff_share}) *share /= all > 0.0 ? all : 1.0;
  return walls;
}

Finding thinWalls(const Walls& walls) {
  return {Finding::Level::kWarning,
          "tissue.spacing: " + percentText(walls.thin_share) +
              " of the walls are no thicker than a spacing, the thinnest " +
              numberText(1e3 * walls.thinnest) +
              " mm: where they lie along the grid they may bend too softly, by Poisson's ratio",
          "tissue.spacing: " + numberText(0.5 * walls.thinnest) + " or less"};
}

Finding obliqueWalls(const Walls& walls) {
  return {Finding::Level::kWarning,
          "tissue.spacing: " + percentText(walls.stiff_share) +
              " of the walls are oblique to the grid and thin for it, one of " +
              numberText(std::round(1e4 * walls.stiffest) / 10.0) + " mm bends " +
              percentText(walls.too_stiff) + " too stiffly",
          "a mesh turned so that its walls lie along the axes, or tissue.spacing: " +
              numberText(walls.spacing) + " or less"};
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
  Walls walls;
  if (tissue.mesh) {
    walls = wallsOf(*tissue.mesh, tissue.spacing);
  } else {
    lookAt(tissue.shape.sizes().minCoeff(), Vec3::UnitX(), 1.0, tissue.spacing, walls);
  }
  Findings findings;
  if (walls.thin_share >= kThinShare) findings.push_back(thinWalls(walls));
  if (walls.stiff_share >= kThinShare) findings.push_back(obliqueWalls(walls));
  return findings;
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
