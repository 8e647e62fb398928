// Scenes as text for the tests of the gate.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "robot_tissue/scene/scene_gate.h"

namespace robot_tissue {

// Accepted by the runner; the tests of bad scenes change one place of it.
inline const std::string kRunnerScene = R"(tissue:
  frame_id: organ
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.1, 0.1, 0.05]}
  spacing: 0.01
  model: six_spring
  material: {young_modulus: 10000.0, density: 900.0}
  regions:
    - {name: tumour, min: [0.03, 0.03, 0.01], max: [0.07, 0.07, 0.03], young_modulus: 1.0e+5}
    - {min: [0.0, 0.0, 0.0], max: [0.02, 0.02, 0.02], density: 1100}
  fixed:
    - {min: [-1.0, -1.0, -1.0e-6], max: [1.0, 1.0, 1.0e-6]}
  gravity: [0.0, 0.0, -9.81]
solver: {method: paper, tolerance: 0.02, max_ms: 8, threads: 1}
tools: []
steps:
  - settle: {}
  - load:
      increments: 5
      patches:
        - {name: punch, min: [0.04, 0.04, 0.05], max: [0.06, 0.06, 0.05], displacement: [free, 0.0, -0.005]}
        - {name: pull, min: [0.0, 0.0, 0.05], max: [0.01, 0.01, 0.05], force: [0.0, 0.5, 1.0]}
  - cut: {corners: [[0.055, 0.02, 0.025], [0.055, 0.08, 0.025], [0.055, 0.08, 0.051]]}
  - release: {patches: [punch]}
  - reset: {}
)";

// Accepted by the node.
inline const std::string kNodeScene = R"(tissue:
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.1, 0.1, 0.05]}
  spacing: 0.01
  material: {young_modulus: 10000.0}
tools:
  - name: probe
    link: tool_tip
    role: push
    padding: 0.001
    shapes:
      - {type: sphere, radius: 0.01, xyz: [0.1, 0.2, 0.3], rpy: [0.1, 0.2, 0.3]}
      - {type: cylinder, radius: 0.004, length: 0.05}
      - {type: box, size: [0.01, 0.02, 0.04]}
      - {type: mesh, resource: package://robot_tissue/tip.stl, scale: 0.001}
  - {link: other_tip}
)";

// One place of a scene changed; an empty text when the place is not there.
inline std::string replaced(std::string scene, const std::string& from, const std::string& to) {
  const std::size_t at = scene.find(from);
  return at == std::string::npos ? std::string() : scene.replace(at, from.size(), to);
}

inline Scene parseText(const std::string& text, SceneUser user) {
  SceneSource source;
  source.name = "block.yaml";
  source.user = user;
  return parseScene(YAML::Load(text), source);
}

// The message of the refusal, empty when the scene is accepted.
inline std::string refusal(const std::string& text, SceneUser user) {
  try {
    parseText(text, user);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace robot_tissue
