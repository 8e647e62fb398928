#include <algorithm>
#include <cmath>
#include <map>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kMostCorners = 1000;

// What the steps are checked against: the scene's tools, and the patches and tools that the steps
// before have put in place.
struct Program {
  const TissueConfig& tissue;
  const SolverConfig& solver;
  const std::vector<ToolConfig>& tools;
  LengthRanges lengths;
  Grid grid;
  std::vector<NodeRange> fixed;
  std::vector<StandingPatch> patches;
  std::set<std::string> placed_tools;
  std::map<std::string, std::vector<StandingPatch>> saved;  // what stands in saved states
  bool patches_are_known =
      true;  // else a state of an earlier run was loaded, with what stood in it
};

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Area vector of the polygon (m^2), by Newell's formula: half the sum of c_i x c_(i+1).
Vec3 areaVector(const std::vector<Vec3>& corners) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i] - corners.front();
    const Vec3 b = corners[(i + 1) % corners.size()] - corners.front();
    area += 0.5 * a.cross(b);
  }
  return area;
}

void checkPolygon(const Entry& entry, const std::vector<Vec3>& corners, double spacing) {
  if (areaVector(corners).norm() < 1e-6 * spacing * spacing) {
    entry.fail("the polygon has no area, must have some");
  }
}

void requireTime(const Entry& entry, const Program& program) {
  if (program.tissue.time) return;
  entry.fail("must be left out unless the scene has tissue.time");
}

struct CutReading {
  const Program& program;
  CutStep step;
};

const KeyTable<CutReading> kCutKeys = {
    {"corners",
     [](const Entry& entry, CutReading& reading) {
       for (const Entry& corner : entry.list(3, "corners", kMostCorners)) {
         reading.step.corners.push_back(corner.vec3(reading.program.lengths.place));
       }
       checkPolygon(entry, reading.step.corners, reading.program.tissue.spacing);
     }},
};

CutStep readCut(const Entry& entry, const Program& program) {
  CutReading reading{program, {}};
  readKeys(MapReader(entry, namesOf(kCutKeys)), kCutKeys, reading);
  return reading.step;
}

std::string readReleasedPatch(const Entry& entry, Program& program) {
  const std::string name = entry.word("the name of a standing patch");
  std::vector<StandingPatch>& standing = program.patches;
  const auto patch = std::find_if(standing.begin(), standing.end(),
                                  [&name](const auto& other) { return other.name == name; });
  if (patch == standing.end() && !program.patches_are_known) return name;
  if (patch == standing.end()) {
    std::vector<std::string> names;
    for (const StandingPatch& other : standing) names.push_back(other.name);
    entry.fail(names.empty() ? "no patch stands at this step, must not release any"
                             : "must be one of the standing patches: " + joined(names));
  }
  standing.erase(patch);
  return name;
}

struct ReleaseReading {
  Program& program;
  ReleaseStep step;
};

void readReleasedPatches(const Entry& entry, ReleaseReading& reading) {
  if (!entry.given()) return;
  for (const Entry& name : entry.list(1, "patch names")) {
    reading.step.patches.push_back(readReleasedPatch(name, reading.program));
  }
}

void readReleasedTools(const Entry& entry, ReleaseReading& reading) {
  if (!entry.given()) return;
  std::vector<std::string>& tools = reading.step.tools;
  for (const Entry& name_entry : entry.list(1, "tool names")) {
    const std::string name = name_entry.word("the name of a tool");
    requireStands(name_entry, name, reading.program.placed_tools);
    if (contains(tools, name)) name_entry.fail("the tool stands here twice, must stand once");
    tools.push_back(name);
  }
}

const KeyTable<ReleaseReading> kReleaseKeys = {{"patches", readReleasedPatches},
                                               {"tools", readReleasedTools}};

ReleaseStep readRelease(const Entry& entry, Program& program) {
  const MapReader map(entry, namesOf(kReleaseKeys));
  if (!map["patches"].given() && !map["tools"].given()) {
    entry.fail("must have patches, tools or both");
  }
  ReleaseReading reading{program, {}};
  readKeys(map, kReleaseKeys, reading);
  return reading.step;
}

Step readReset(const Entry& entry, Program& program) {
  const MapReader without_keys(entry, {});
  program.patches.clear();
  program.patches_are_known = true;
  program.placed_tools.clear();
  return ResetStep();
}

Step followSave(const Entry& entry, Program& program) {
  SaveStep step = readSave(entry);
  program.saved[step.file] = program.patches;
  return step;
}

Step followLoadState(const Entry& entry, Program& program) {
  LoadStateStep step = readLoadState(entry);
  const auto saved = program.saved.find(step.file);
  program.patches_are_known = saved != program.saved.end();
  program.patches = program.patches_are_known ? saved->second : std::vector<StandingPatch>();
  return step;
}

struct StepKind {
  std::string name;
  Step (*read)(const Entry&, Program&);
};

const std::vector<StepKind>& stepKinds() {
  static const std::vector<StepKind> kinds = {
      {"settle",
       [](const Entry& entry, Program&) -> Step {
         MapReader(entry, {});
         return SettleStep();
       }},
      {"load",
       [](const Entry& entry, Program& program) -> Step {
         return readLoad(entry, program.grid, program.fixed, program.solver,
                         program.lengths.displacement, program.patches);
       }},
      {"cut", [](const Entry& entry, Program& program) -> Step { return readCut(entry, program); }},
      {"move",
       [](const Entry& entry, Program& program) -> Step {
         MoveStep step = readMove(entry, program.tools, program.lengths, program.placed_tools);
         if (step.duration) requireTime(entry, program);
         return step;
       }},
      {"wait",
       [](const Entry& entry, Program& program) -> Step {
         requireTime(entry, program);
         return readWait(entry);
       }},
      {"push",
       [](const Entry& entry, Program& program) -> Step {
         return readPush(entry, program.tools, program.placed_tools);
       }},
      {"grasp",
       [](const Entry& entry, Program& program) -> Step {
         return readGraspStep(entry, program.tools, program.placed_tools);
       }},
      {"suture",
       [](const Entry& entry, Program& program) -> Step {
         return readSuture(entry, program.tissue.model, program.lengths);
       }},
      {"release",
       [](const Entry& entry, Program& program) -> Step { return readRelease(entry, program); }},
      {"reset", readReset},
      {"remove",
       [](const Entry& entry, Program& program) -> Step {
         return readRemove(entry, program.lengths);
       }},
      {"undo", [](const Entry& entry, Program&) -> Step { return readUndo(entry); }},
      {"save", followSave},
      {"load_state", followLoadState},
  };
  return kinds;
}

std::vector<std::string> stepNames() {
  std::vector<std::string> names;
  for (const StepKind& kind : stepKinds()) names.push_back(kind.name);
  return names;
}

// The name of the step is the only key of its map.
Step readStep(const Entry& entry, Program& program) {
  const std::vector<std::string> names = stepNames();
  const std::string allowed = "must be a map with exactly one key of " + joined(names);
  if (!entry.node().IsMap() || entry.node().size() != 1) entry.fail(allowed);
  const YAML::Node key = entry.node().begin()->first;
  const std::string name = key.IsScalar() ? key.Scalar() : "";
  const MapReader map(entry, names);
  const auto kind = std::find_if(stepKinds().begin(), stepKinds().end(),
                                 [&name](const StepKind& each) { return each.name == name; });
  return kind->read(map[name], program);
}

}  // namespace

std::vector<Step> readSteps(const Entry& entry, const TissueConfig& tissue,
                            const SolverConfig& solver, const std::vector<ToolConfig>& tools) {
  Program program{tissue, solver, tools, lengthsOf(tissue), filledGrid(tissue).grid, {}, {},
                  {},     {},     true};
  for (const Box& box : tissue.fixed) program.fixed.push_back(program.grid.nodesIn(box));
  std::vector<Step> steps;
  for (const Entry& step_entry : entry.list(0, "steps", kMostSteps)) {
    steps.push_back(readStep(step_entry, program));
  }
  return steps;
}

}  // namespace robot_tissue
