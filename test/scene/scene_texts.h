// Scenes as text for the tests of the gate.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "robot_tissue/scene/scene_parser.h"

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

// Accepted by the runner: tools with and without links, supports, and every step that a tool takes.
inline const std::string kToolScene = R"(tissue:
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.1, 0.1, 0.05]}
  spacing: 0.01
  material: {young_modulus: 10000.0}
tools:
  - name: probe
    friction: 0.4
    max_force: 5.0
    shapes:
      - {type: sphere, radius: 0.01, padding: 0.0005}
  - name: fork
    patch: rigid
    links:
      - {padding: 0.001, shapes: [{type: sphere, radius: 0.002, xyz: [0.01, 0.0, 0.0]}]}
      - {shapes: [{type: sphere, radius: 0.003}]}
  - name: forceps
    role: grasper
    jaws: [{shapes: [{type: box, size: [0.01, 0.002, 0.02]}]}, {shapes: [{type: sphere, radius: 0.004}]}]
    grasp: {close_gap: 0.004, open_gap: 0.009, max_force: 2.0, opening_axis: [0.0, 0.0, -3.0]}
  - links: [wrist, {link: tip, padding: 0.002, collision_padding: {fin: 0.003, rib-1: 0.0}}]
  - {link: gripper, role: grasper, jaws: [left_jaw, {link: right_jaw, shapes: [{type: sphere, radius: 0.003}]}]}
supports:
  - {name: table, type: plane, point: [0.05, 0.04, -0.01], normal: [0.0, 0.0, 2.0], friction: 0.5}
  - {type: box, min: [0.1, 0.0, 0.0], max: [0.12, 0.1, 0.06]}
steps:
  - move: {tool: probe, from: {xyz: [0.05, 0.05, 0.07], rpy: [0.0, 0.0, 1.5707963267948966]}, to: {xyz: [0.05, 0.05, 0.055]}, increments: 20}
  - push: {tool: probe, force: [0.0, 0.5, -1.0], increments: 4}
  - move: {tool: forceps, from: {xyz: [0.02, 0.02, 0.08], opening: 0.01}, to: {xyz: [0.02, 0.02, 0.05]}}
  - grasp: {tool: forceps}
  - move: {tool: forceps, to: {xyz: [0.02, 0.02, 0.06], opening: 0.002}}
  - release: {tools: [forceps, probe]}
  - reset: {}
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
