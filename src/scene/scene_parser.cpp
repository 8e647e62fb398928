#include "robot_tissue/scene/scene_parser.h"

#include <filesystem>

#include "robot_tissue/mesh/regular_file.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"
#include "scene_text.h"

namespace robot_tissue {
namespace {

std::string readFile(const std::string& path) {
  try {
    return readRegularFile(path, kLargestSceneFile);
  } catch (const InputError& error) {
    throw InputError(onOneLine(path) + ": " + error.what() +
                     ": must be a scene file that can be read, up to 10 MB");
  }
}

// By the method that it is solved with; readTissue knows the model's own only.
void requireMemoryOfMethod(const Entry& tissue, const Scene& scene) {
  requireMemory(tissue.child(tissue.node()["spacing"], "spacing"), scene.tissue,
                scene.solver.method);
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
  requireMemoryOfMethod(map["tissue"], scene);
  if (map["tools"].given()) {
    scene.tools = readTools(map["tools"], source, scene.tissue, scene.remarks);
  }
  if (map["supports"].given()) {
    scene.supports = readSupports(map["supports"], scene.tissue);
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
