#include "scene_checks.h"

#include <cmath>

#include "robot_checks.h"
#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"
#include "robot_tissue/scene/wall_remarks.h"

namespace robot_tissue {
namespace {

constexpr double kLargestOrgan = 10.0;    // m: whatever is larger was drawn in another unit. Chosen
constexpr double kSmallestOrgan = 0.002;  // m. Chosen

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

}  // namespace

Findings checkUnits(const YAML::Node& scene, const std::string& folder) {
  Vec3 extents = Vec3::Zero();
  try {
    extents = extentOf(scene["tissue"]["shape"], folder);
  } catch (const std::exception&) {
    return {};  // the scene's own checks say what is wrong with it
  }
  if (!(extents.minCoeff() > 0.0)) return {};  // likewise
  const double extent = extents.maxCoeff();
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
  Findings findings;
  for (const WallRemark& remark : wallRemarks(tissue)) {
    findings.push_back({Finding::Level::kWarning, "tissue.spacing: " + remark.text, remark.remedy});
  }
  return findings;
}

Findings checkForNode(const Scene& scene) {
  Findings findings;
  // Of scissors without jaws the runner reads the tool's own link three times.
  const auto has_no_jaws = [](const ToolConfig& tool) {
    return tool.role.shears && tool.links.back().path == tool.links.front().path;
  };
  for (const ToolConfig& tool : scene.tools) {
    if (namesLink(tool)) {
      if (!has_no_jaws(tool)) continue;
      findings.push_back({Finding::Level::kError,
                          "tools: '" + tool.name + "' has no jaws: only simulate runs it",
                          "jaws: the two links of the robot's URDF that its edges are on"});
      continue;
    }
    findings.push_back({Finding::Level::kWarning,
                        "tools: '" + tool.name + "' names no link: only simulate runs it",
                        "link: a link of the robot's URDF"});
  }
  if (scene.tissue.fixed.empty() && scene.supports.empty()) {
    findings.push_back({Finding::Level::kWarning,
                        "tissue.fixed: nothing holds the tissue: a tool pushes it away",
                        "tissue.fixed, or supports"});
  }
  return findings;
}

}  // namespace robot_tissue
