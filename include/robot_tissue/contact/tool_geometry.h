// The collision geometry of the tools, from the robot's URDF or from a scene's overlay.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct ToolGeometry {
  std::string name;
  std::string link;
  double padding = 0.0;           // m
  std::vector<ToolShape> shapes;  // placed in the link's frame; none: the tool touches nothing
};

struct LoadedTools {
  std::vector<ToolGeometry> tools;    // one per ToolConfig, same order
  std::vector<std::string> warnings;  // one line each, e.g. a link without collision geometry
};

// In: the URDF's text, the scene's tools. A tool's overlay takes the place of its link's geometry;
// the link has to exist all the same. Meshes are named here and loaded by ContactFinder.
// Throws InputError: URDF that does not parse, a link it does not have. No tools: no URDF needed.
LoadedTools loadTools(const std::string& urdf_xml, const std::vector<ToolConfig>& configs);

}  // namespace robot_tissue
