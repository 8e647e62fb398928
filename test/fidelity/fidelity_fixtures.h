// Small scenes for the tests of `fidelity`.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "robot_tissue/scene/scene_parser.h"

namespace robot_tissue {

// A block of 60 x 60 x 40 mm, its bottom fixed.
inline std::string blockText(const std::string& spacing = "0.01") {
  return "# a block\n"
         "tissue:\n"
         "  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.06, 0.04]}\n"
         "  spacing: " +
         spacing +
         "   # m\n"
         "  material: {young_modulus: 10000.0, poisson_ratio: 0.3}\n"
         "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n";
}

inline const std::string kPress =
    "steps:\n"
    "  - load: {patches: [{name: punch, min: [0.02, 0.02, 0.04], max: [0.04, 0.04, 0.04],"
    " displacement: [0, 0, -0.002]}]}\n";

inline Scene sceneOf(const std::string& text) {
  SceneSource source;
  source.name = "scene.yaml";
  return parseScene(YAML::Load(text), source);
}

}  // namespace robot_tissue
