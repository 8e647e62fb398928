#include "robot_checks.h"

#include <algorithm>

#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/contact/tool_sizes.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kThinnestTool = 0.1;  // spacings: it slips through between the nodes. Chosen

double extentOf(const TissueConfig& tissue) {
  const Box box = tissue.mesh ? boundsOf(tissue.mesh->vertices) : tissue.shape;
  return box.sizes().maxCoeff();
}

// Throws InputError where a mesh cannot be used.
Findings checkSizes(const Scene& scene, const ToolGeometry& tool) {
  Findings findings;
  const ContactFinder finder({tool});
  for (const std::string& warning : finder.warnings()) {
    findings.push_back({Finding::Level::kWarning, warning, "mend the mesh, or give shapes"});
  }
  for (std::size_t number = 0; number < tool.links.size(); ++number) {
    const LinkGeometry& link = tool.links[number];
    if (link.shapes.empty()) continue;
    const std::string name = "tools: link '" + link.link + "' of '" + tool.name + "'";
    const double extent = finder.bounds(number, Pose::Identity()).sizes().maxCoeff();
    const std::string remark = remarkOnSize(tool.name, link.link, extent, extentOf(scene.tissue));
    if (!remark.empty()) {
      findings.push_back({Finding::Level::kWarning, "tools: " + remark,
                          "scale of its mesh, in the URDF or in shapes, or a smaller shape"});
    } else if (finder.thickness(number) < kThinnestTool * scene.tissue.spacing) {
      findings.push_back({Finding::Level::kWarning,
                          name + " is " + numberText(1e3 * finder.thickness(number)) +
                              " mm thin: its load steps are short and updates slow",
                          "padding, or a smaller tissue.spacing"});
    }
  }
  return findings;
}

// A tool that names no link is none of the robot's: only the runner has it.
Findings checkTool(const Scene& scene, const ToolConfig& tool, const std::string& urdf) {
  Findings findings;
  const char* remedy = "a link that the robot has";
  try {
    const bool is_of_robot = namesLink(tool) && !urdf.empty();
    const LoadedTools loaded = is_of_robot ? loadTools(urdf, {tool}) : toolsOf({tool});
    remedy =
        "mend that shape (of a mesh: its file, address or scale), or give the link `shapes` in the "
        "scene";
    // Without a URDF it is not known what is missing. They tell their remedies themselves.
    if (!urdf.empty()) {
      for (const std::string& warning : loaded.warnings) {
        findings.push_back({Finding::Level::kWarning, warning, ""});
      }
    }
    const Findings sizes = checkSizes(scene, loaded.tools.front());
    findings.insert(findings.end(), sizes.begin(), sizes.end());
  } catch (const InputError& error) {
    const bool is_of_urdf = std::string(error.what()).rfind("robot_description:", 0) == 0;
    if (is_of_urdf) remedy = "mend the URDF, or give the link `shapes` in the scene";
    findings.push_back({Finding::Level::kError, error.what(), remedy});
  }
  return findings;
}

}  // namespace

bool namesLink(const ToolConfig& tool) {
  return std::any_of(tool.links.begin(), tool.links.end(),
                     [](const ToolLink& link) { return !link.link.empty(); });
}

Findings checkTools(const Scene& scene, const std::string& urdf) {
  Findings findings;
  for (const ToolConfig& tool : scene.tools) {
    const Findings of_tool = checkTool(scene, tool, urdf);
    findings.insert(findings.end(), of_tool.begin(), of_tool.end());
  }
  return findings;
}

std::vector<std::string> framesOf(const Scene& scene) {
  std::vector<std::string> frames;
  for (const ToolConfig& tool : scene.tools) {
    for (const ToolLink& link : tool.links) {
      const bool known = std::find(frames.begin(), frames.end(), link.link) != frames.end();
      if (!link.link.empty() && !known) frames.push_back(link.link);
    }
  }
  return frames;
}

}  // namespace robot_tissue
