#include "robot_tissue/scene/scene_gate.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

std::string readFile(const std::string& path) {
  const std::string allowed = ": must be a scene file that can be read";
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(onOneLine(path) + ": is a folder" + allowed);
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.is_open() && !file.bad()) return text;
  throw InputError(onOneLine(path) + ": " + std::strerror(errno != 0 ? errno : EIO) + allowed);
}

YAML::Node parseYaml(const std::string& text, const std::string& path) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      throw InputError(onOneLine(path) + ": has " + std::to_string(documents.size()) +
                       " YAML documents, must have one");
    }
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const YAML::Exception& error) {
    const std::string at = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    throw InputError(onOneLine(path) + at + ": not YAML: " + onOneLine(error.msg));
  }
}

void readSteps(const Entry& steps, const SceneSource& source, Scene& scene) {
  if (!steps.given()) return;
  if (source.user == SceneUser::kRunner) {
    scene.steps = readSteps(steps, scene.tissue, scene.solver, scene.tools);
  } else if (!steps.list(0, "steps").empty()) {
    scene.remarks.push_back(steps.line("ignored, only the offline runner takes steps"));
  }
}

}  // namespace

Scene parseScene(const YAML::Node& root, const SceneSource& source) {
  std::vector<std::string> keys = {"tissue", "solver", "tools", "supports", "steps"};
  keys.insert(keys.end(), source.other_keys.begin(), source.other_keys.end());
  const MapReader map(Entry(root, "", source.name), keys);
  Scene scene;
  const bool supported = map["supports"].given() && map["supports"].node().size() > 0;
  scene.tissue = readTissue(map["tissue"], source.folder, supported, scene.remarks);
  scene.solver = readSolver(map["solver"], scene.tissue.model, source.overrides, scene.remarks);
  if (map["tools"].given()) {
    scene.tools = readTools(map["tools"], source, scene.tissue, scene.remarks);
  }
  if (map["supports"].given()) {
    scene.supports = readSupports(map["supports"], scene.tissue.model);
  }
  readSteps(map["steps"], source, scene);
  return scene;
}

Scene loadScene(const std::string& path, const SolverOverrides& overrides) {
  SceneSource source;
  source.name = path;
  source.folder = std::filesystem::absolute(path).parent_path().string();
  source.overrides = overrides;
  return parseScene(parseYaml(readFile(path), path), source);
}

}  // namespace robot_tissue
