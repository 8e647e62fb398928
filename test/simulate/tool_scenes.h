// Small scenes with tools for the tests of the runner.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "robot_tissue/scene/scene_parser.h"
#include "run_scene.h"

namespace robot_tissue {

constexpr double kSpacing = 0.01;
constexpr double kTop = 0.05;

// 10 x 10 x 5 cells, its bottom fixed; `more`: further keys of the tissue.
inline std::string block(const std::string& more = "") {
  return "tissue:\n"
         "  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n"
         "  spacing: 0.01\n"
         "  material: {young_modulus: 10000.0}\n"
         "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n" +
         more;
}

inline const std::string kSphere =
    "tools: [{name: probe, shapes: [{type: sphere, radius: 0.02}]}]\n";

inline Scene sceneOf(const std::string& text) {
  SceneSource source;
  source.name = "scene.yaml";
  return parseScene(YAML::Load(text), source);
}

inline RunResult run(const std::string& text) { return runScene(sceneOf(text)); }

// "[x, y, z]"
inline std::string list(const Vec3& v) {
  return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) +
         "]";
}

inline std::string placed(const std::string& tool, const Vec3& from, const Vec3& to,
                          int increments) {
  return "  - move: {tool: " + tool + ", from: {xyz: " + list(from) + "}, to: {xyz: " + list(to) +
         "}, increments: " + std::to_string(increments) + "}\n";
}

inline std::string moved(const std::string& tool, const Vec3& to, int increments) {
  return "  - move: {tool: " + tool + ", to: {xyz: " + list(to) +
         "}, increments: " + std::to_string(increments) + "}\n";
}

// Center of the sphere when its lowest point is `depth` below the block's top (m).
inline Vec3 sphereAt(double depth, double x = 0.05) { return {x, 0.05, kTop + 0.02 - depth}; }

inline std::vector<ToolRow> rowsOf(const RunResult& result, int step, const std::string& tool) {
  std::vector<ToolRow> rows;
  for (const ToolRow& row : result.tools) {
    if (row.step == step && row.tool == tool) rows.push_back(row);
  }
  return rows;
}

inline double greatestDisplacement(const RunResult& result) {
  double greatest = 0.0;
  for (const Vec3& moved : result.displacement) greatest = std::max(greatest, moved.norm());
  return greatest;
}

}  // namespace robot_tissue
