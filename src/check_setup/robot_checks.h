// The tools against the robot's description.
#pragma once

#include <string>
#include <vector>

#include "finding.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Whether a tool is one of the robot's; only the runner has others.
bool namesLink(const ToolConfig& tool);

// Of each tool: links, their geometry and its size beside the tissue's. No URDF: the overlays
// alone.
Findings checkTools(const Scene& scene, const std::string& urdf);

// Frames that the node looks for, each once.
std::vector<std::string> framesOf(const Scene& scene);

}  // namespace robot_tissue
