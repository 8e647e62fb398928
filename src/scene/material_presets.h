// Materials by name (tissue.material.preset): numbers from the literature, each with its source.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct MaterialPreset {
  std::string name;
  Material material;
  std::string source;  // of each number, with its range and strain
};

const std::vector<MaterialPreset>& materialPresets();

// A line that says what the preset sets, and from where.
std::string describe(const MaterialPreset& preset);

}  // namespace robot_tissue
