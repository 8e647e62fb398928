// The collision geometry of the tools, from the robot's URDF or from a scene's overlay.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct LinkGeometry {
  std::string link;
  std::vector<ToolShape> shapes;  // in the link's frame, all paddings in ToolShape::padding; none:
                                  // the link touches nothing
};

struct ToolGeometry {
  std::string name;
  std::vector<LinkGeometry> links;  // as in ToolConfig
  ToolRole role;
  ToolConfig::Patch patch = ToolConfig::Patch::kConforming;
  double friction = 0.3;
  double max_force = 0.0;  // N, 0 = none
  GraspConfig grasp;
  BladeConfig blade;
  ScissorsConfig scissors;
};

struct LoadedTools {
  std::vector<ToolGeometry> tools;    // one per ToolConfig, same order
  std::vector<std::string> warnings;  // one line each, e.g. a link without collision geometry
};

// Throws InputError where it does not parse, or is empty.
void requireUrdf(const std::string& urdf_xml);

// In: the URDF's text, the scene's tools. A link's overlay takes the place of its collision
// geometry; the link has to exist all the same. Meshes are named here and loaded by ContactFinder.
// Throws InputError: URDF that does not parse, a link or a padded collision that it does not have.
// No tools: no URDF needed.
LoadedTools loadTools(const std::string& urdf_xml, const std::vector<ToolConfig>& configs);

// A link whose shapes only a URDF can tell; none: the overlays are enough.
std::optional<std::string> linkThatNeedsUrdf(const std::vector<ToolConfig>& configs);

// Without a URDF: the overlays alone.
LoadedTools toolsOf(const std::vector<ToolConfig>& configs);

}  // namespace robot_tissue
