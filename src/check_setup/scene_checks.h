// Checks that need the scene alone: neither a robot nor a solve.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "finding.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Of the scene as it is written, also where it is refused later: the largest extent of its shape.
// Says nothing of what the scene's own checks refuse.
Findings checkUnits(const YAML::Node& scene, const std::string& folder);

// Walls against the lattice's spacing: what one cell spans does not bend as it should.
Findings checkWalls(const TissueConfig& tissue);

// What the node asks for that the runner does not.
Findings checkForNode(const Scene& scene);

}  // namespace robot_tissue
