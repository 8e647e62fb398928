// The one gate that scenes pass: YAML in, checked plain data out (core/scene.h).
// Both users read the same keys: the offline runner a file, the node its private parameters.
// Throws InputError, one line: source, key's full path, value as written, what is allowed.
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// The runner has steps and no URDF; the node no steps, and a link of the URDF for every tool.
enum class SceneUser { kRunner, kNode };

// Values of the command line, as typed; each takes the place of the scene's solver entry.
struct SolverOverrides {
  std::optional<std::string> method;
  std::optional<std::string> tolerance;
  std::optional<std::string> threads;
};

struct SceneSource {
  std::string name;  // of the file or the node, for messages
  SceneUser user = SceneUser::kRunner;
  std::string folder;                   // of the scene file; empty: relative paths are refused
  std::vector<std::string> other_keys;  // keys beside the scene's own that someone else reads
  SolverOverrides overrides;
};

Scene parseScene(const YAML::Node& root, const SceneSource& source);

constexpr std::size_t kLargestSceneFile = 10000000;  // bytes

// The file as it is written, unchecked but for its size and form.
YAML::Node loadSceneText(const std::string& path);

// Reads a file for the runner.
Scene loadScene(const std::string& path, const SolverOverrides& overrides = {});

}  // namespace robot_tissue
