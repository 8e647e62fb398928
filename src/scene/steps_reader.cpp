#include <algorithm>
#include <cmath>
#include <map>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

struct Standing {
  std::vector<StandingPatch> patches;
  bool are_known = true;  // else more may stand, from a state of an earlier run
};

// What the steps are checked against: the scene's tools, and the patches and tools that the steps
// before have put in place.
struct Program {
  const TissueConfig& tissue;
  const SolverConfig& solver;
  const std::vector<ToolConfig>& tools;
  LengthRanges lengths;
  Grid grid;
  std::vector<NodeRange> fixed;
  Standing standing;
  std::set<std::string> placed_tools;
  std::map<std::string, Standing> saved;  // what stands in saved states
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
       for (const Entry& corner : entry.list(3, "corners", ranges::kMostCutCorners)) {
         reading.step.corners.push_back(corner.vec3(reading.program.lengths.place));
       }
       checkPolygon(entry, reading.step.corners, reading.program.tissue.spacing);
     }},
};

Step followCut(const Entry& entry, Program& program) {
  CutReading reading{program, {}};
  readKeys(MapReader(entry, namesOf(kCutKeys)), kCutKeys, reading);
  return reading.step;
}

std::string readReleasedPatch(const Entry& entry, Program& program) {
  const std::string name = entry.word("the name of a standing patch");
  std::vector<StandingPatch>& standing = program.standing.patches;
  const auto patch = std::find_if(standing.begin(), standing.end(),
                                  [&name](const auto& other) { return other.name == name; });
  if (patch == standing.end() && !program.standing.are_known) return name;
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

Step followRelease(const Entry& entry, Program& program) {
  const MapReader map(entry, namesOf(kReleaseKeys));
  if (!map["patches"].given() && !map["tools"].given()) {
    entry.fail("must have patches, tools or both");
  }
  ReleaseReading reading{program, {}};
  readKeys(map, kReleaseKeys, reading);
  return reading.step;
}

Step followReset(const Entry& entry, Program& program) {
  const MapReader without_keys(entry, {});
  program.standing = Standing();
  program.placed_tools.clear();
  return ResetStep();
}

Step followSave(const Entry& entry, Program& program) {
  SaveStep step = readSave(entry);
  program.saved[step.file] = program.standing;
  return step;
}

Step followLoadState(const Entry& entry, Program& program) {
  LoadStateStep step = readLoadState(entry);
  const auto saved = program.saved.find(step.file);
  program.standing = saved != program.saved.end() ? saved->second : Standing{{}, false};
  return step;
}

Step followSettle(const Entry& entry, Program&) {
  const MapReader without_keys(entry, {});
  return SettleStep();
}

Step followLoad(const Entry& entry, Program& program) {
  return readLoad(entry, program.grid, program.fixed, program.solver, program.lengths.displacement,
                  program.standing.patches);
}

Step followMove(const Entry& entry, Program& program) {
  MoveStep step = readMove(entry, program.tools, program.lengths, program.placed_tools);
  if (step.duration) requireTime(entry.child(entry.node()["duration"], "duration"), program);
  return step;
}

Step followWait(const Entry& entry, Program& program) {
  requireTime(entry, program);
  return readWait(entry);
}

Step followPush(const Entry& entry, Program& program) {
  return readPush(entry, program.tools, program.placed_tools);
}

Step followGrasp(const Entry& entry, Program& program) {
  return readGraspStep(entry, program.tools, program.placed_tools);
}

Step followSuture(const Entry& entry, Program& program) {
  return readSuture(entry, program.tissue.model, program.lengths);
}

Step followRemove(const Entry& entry, Program& program) {
  return readRemove(entry, program.lengths);
}

Step followUndo(const Entry& entry, Program&) { return readUndo(entry); }

struct StepKind {
  std::string name;
  Step (*follow)(const Entry&, Program&);
};

const std::vector<StepKind> kStepKinds = {
    {"settle", followSettle},   {"load", followLoad},
    {"cut", followCut},         {"move", followMove},
    {"wait", followWait},       {"push", followPush},
    {"grasp", followGrasp},     {"suture", followSuture},
    {"release", followRelease}, {"reset", followReset},
    {"remove", followRemove},   {"undo", followUndo},
    {"save", followSave},       {"load_state", followLoadState},
};

std::vector<std::string> stepNames() {
  std::vector<std::string> names;
  for (const StepKind& kind : kStepKinds) names.push_back(kind.name);
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
  const auto kind = std::find_if(kStepKinds.begin(), kStepKinds.end(),
                                 [&name](const StepKind& each) { return each.name == name; });
  return kind->follow(map[name], program);
}

}  // namespace

std::vector<Step> readSteps(const Entry& entry, const TissueConfig& tissue,
                            const SolverConfig& solver, const std::vector<ToolConfig>& tools) {
  Program program{tissue, solver, tools, lengthsOf(tissue), filledGrid(tissue).grid, {},
                  {},     {},     {}};
  for (const Box& box : tissue.fixed) program.fixed.push_back(program.grid.nodesIn(box));
  std::vector<Step> steps;
  for (const Entry& step_entry : entry.list(0, "steps", kMostSteps)) {
    steps.push_back(readStep(step_entry, program));
  }
  return steps;
}

}  // namespace robot_tissue
