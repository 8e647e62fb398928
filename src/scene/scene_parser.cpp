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

// By the method that it is solved with, and with its membranes; readTissue knows neither.
void requireMemoryOfMethod(const Entry& tissue, const Scene& scene) {
  requireMemory(tissue.child(tissue.node()["spacing"], "spacing"), scene.tissue,
                scene.solver.method);
}

struct SceneReading {
  const SceneSource& source;
  const MapReader& map;
  Scene scene;
};

void readTissuePart(const Entry& entry, SceneReading& reading) {
  const Entry supports = reading.map["supports"];
  const bool supported = supports.given() && supports.node().size() > 0;
  reading.scene.tissue = readTissue(entry, reading.source.folder, supported, reading.scene.remarks);
}

void readSolverPart(const Entry& entry, SceneReading& reading) {
  Scene& scene = reading.scene;
  scene.solver = readSolver(entry, scene.tissue, reading.source.overrides, scene.remarks);
  requireMemoryOfMethod(reading.map["tissue"], scene);
}

void readStepsPart(const Entry& entry, SceneReading& reading) {
  if (!entry.given()) return;
  Scene& scene = reading.scene;
  if (reading.source.user == SceneUser::kRunner) {
    scene.steps = readSteps(entry, scene.tissue, scene.solver, scene.tools);
  } else if (!entry.list(0, "steps", kMostSteps).empty()) {
    scene.remarks.push_back(entry.line("ignored, only the offline runner takes steps"));
  }
}

// One iteration a small step does not carry damping from cell to cell (doc/time.md).
void remarkToolsInTime(const Entry& entry, Scene& scene) {
  if (!scene.tissue.time || scene.tools.empty() || scene.solver.method != "xpbd") return;
  scene.remarks.push_back(entry.line(
      "beside tissue.time the forces of method xpbd on tools are up to a fifth too low"));
}

const KeyTable<SceneReading> kSceneKeys = {
    {"tissue", readTissuePart},
    {"solver", readSolverPart},
    {"tools",
     [](const Entry& entry, SceneReading& reading) {
       Scene& scene = reading.scene;
       if (!entry.given()) return;
       scene.tools = readTools(entry, reading.source, scene.tissue, scene.remarks);
       remarkToolsInTime(entry, scene);
     }},
    {"supports",
     [](const Entry& entry, SceneReading& reading) {
       if (!entry.given()) return;
       reading.scene.supports = readSupports(entry, reading.scene.tissue);
     }},
    {"steps", readStepsPart},
};

}  // namespace

Scene parseScene(const YAML::Node& root, const SceneSource& source) {
  std::vector<std::string> keys = namesOf(kSceneKeys);
  keys.insert(keys.end(), source.other_keys.begin(), source.other_keys.end());
  const MapReader map(Entry(root, "", source.name), keys);
  SceneReading reading{source, map, {}};
  readKeys(map, kSceneKeys, reading);
  return std::move(reading.scene);
}

YAML::Node loadSceneText(const std::string& path) { return parseYaml(readFile(path), path); }

Scene loadScene(const std::string& path, const SolverOverrides& overrides) {
  SceneSource source;
  source.name = path;
  source.folder = std::filesystem::absolute(path).parent_path().string();
  source.overrides = overrides;
  return parseScene(loadSceneText(path), source);
}

}  // namespace robot_tissue
