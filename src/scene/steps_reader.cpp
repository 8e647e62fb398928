#include <algorithm>
#include <cmath>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const std::vector<std::string> kSteps = {"settle", "load",  "cut",     "move",
                                         "push",   "grasp", "release", "reset"};
constexpr std::size_t kMostSteps = 1000000;
constexpr std::size_t kMostCorners = 1000;
const std::vector<std::string> kPlannedSteps = {"suture"};

// What the steps are read against, and what stands on the way through them.
struct Program {
  const TissueConfig& tissue;
  const SolverConfig& solver;
  const std::vector<ToolConfig>& tools;
  LengthRanges lengths;
  Grid grid;
  std::vector<NodeRange> fixed;
  std::vector<StandingPatch> patches;
  std::set<std::string> placed_tools;
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
  const Vec3 area = areaVector(corners);
  if (area.norm() < 1e-6 * spacing * spacing) {
    entry.fail("the polygon has no area, must have some");
  }
  const Vec3 normal = area.normalized();
  Vec3 center = Vec3::Zero();
  for (const Vec3& corner : corners) center += corner / static_cast<double>(corners.size());
  for (const Vec3& corner : corners) {
    const double distance = std::abs(normal.dot(corner - center));
    if (distance <= 0.5 * spacing) continue;
    entry.fail("a corner is " + numberText(distance) +
               " m off the polygon's plane, must be at most half a spacing, " +
               numberText(0.5 * spacing) + " m");
  }
}

CutStep readCut(const Entry& entry, const LengthRanges& lengths, double spacing) {
  const MapReader map(entry, {"corners"});
  CutStep step;
  for (const Entry& corner : map["corners"].list(3, "corners", kMostCorners)) {
    step.corners.push_back(corner.vec3(lengths.place));
  }
  checkPolygon(map["corners"], step.corners, spacing);
  return step;
}

std::string readReleasedPatch(const Entry& entry, std::vector<StandingPatch>& standing) {
  const std::string name = entry.word("the name of a standing patch");
  const auto patch = std::find_if(standing.begin(), standing.end(),
                                  [&name](const auto& other) { return other.name == name; });
  if (patch == standing.end()) {
    std::vector<std::string> names;
    for (const StandingPatch& other : standing) names.push_back(other.name);
    entry.fail(names.empty() ? "no patch stands at this step, must not release any"
                             : "must be one of the standing patches: " + joined(names));
  }
  standing.erase(patch);
  return name;
}

ReleaseStep readRelease(const Entry& entry, Program& program) {
  const MapReader map(entry, {"patches", "tools"});
  const Entry patches = map["patches"];
  const Entry tools = map["tools"];
  if (!patches.given() && !tools.given()) entry.fail("must have patches, tools or both");
  ReleaseStep step;
  if (patches.given()) {
    for (const Entry& name : patches.list(1, "patch names")) {
      step.patches.push_back(readReleasedPatch(name, program.patches));
    }
  }
  if (tools.given()) {
    for (const Entry& name_entry : tools.list(1, "tool names")) {
      const std::string name = name_entry.word("the name of a tool");
      requireStands(name_entry, name, program.placed_tools);
      if (contains(step.tools, name))
        name_entry.fail("the tool stands here twice, must stand once");
      step.tools.push_back(name);
    }
  }
  return step;
}

// The name of the step, the only key of its map.
std::string readKind(const Entry& entry) {
  const std::string allowed = "must be a map with exactly one key of " + joined(kSteps);
  if (!entry.node().IsMap() || entry.node().size() != 1) entry.fail(allowed);
  const YAML::Node key = entry.node().begin()->first;
  const std::string kind = key.IsScalar() ? key.Scalar() : "";
  if (contains(kPlannedSteps, kind)) {
    entry.child(entry.node().begin()->second, kind)
        .fail("not available yet, must be one of " + joined(kSteps));
  }
  return kind;
}

Step readStep(const std::string& kind, const Entry& entry, Program& program) {
  if (kind == "load") {
    return readLoad(entry, program.grid, program.fixed, program.solver,
                    program.lengths.displacement, program.patches);
  }
  if (kind == "cut") return readCut(entry, program.lengths, program.tissue.spacing);
  if (kind == "move") return readMove(entry, program.tools, program.lengths, program.placed_tools);
  if (kind == "push") return readPush(entry, program.tools, program.placed_tools);
  if (kind == "grasp") return readGraspStep(entry, program.tools, program.placed_tools);
  if (kind == "release") return readRelease(entry, program);
  MapReader(entry, {});
  if (kind == "settle") return SettleStep();
  program.patches.clear();
  program.placed_tools.clear();
  return ResetStep();
}

}  // namespace

std::vector<Step> readSteps(const Entry& entry, const TissueConfig& tissue,
                            const SolverConfig& solver, const std::vector<ToolConfig>& tools) {
  Program program{tissue, solver, tools, lengthsOf(tissue), filledGrid(tissue).grid, {}, {}, {}};
  for (const Box& box : tissue.fixed) program.fixed.push_back(program.grid.nodesIn(box));
  std::vector<Step> steps;
  for (const Entry& step_entry : entry.list(0, "steps", kMostSteps)) {
    const std::string kind = readKind(step_entry);
    const MapReader map(step_entry, kSteps);
    steps.push_back(readStep(kind, map[kind], program));
  }
  return steps;
}

}  // namespace robot_tissue
