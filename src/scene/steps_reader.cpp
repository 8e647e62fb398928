#include <algorithm>
#include <cmath>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const std::vector<std::string> kSteps = {"settle", "load", "cut", "release", "reset"};
const std::vector<std::string> kPlannedSteps = {"suture", "move"};

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

CutStep readCut(const Entry& entry, double spacing) {
  const MapReader map(entry, {"corners"});
  CutStep step;
  for (const Entry& corner : map["corners"].list(3, "corners")) {
    step.corners.push_back(corner.vec3(Range::any("m")));
  }
  checkPolygon(map["corners"], step.corners, spacing);
  return step;
}

ReleaseStep readRelease(const Entry& entry, std::vector<StandingPatch>& standing) {
  const MapReader map(entry, {"patches"});
  ReleaseStep step;
  for (const Entry& name_entry : map["patches"].list(1, "patch names")) {
    const std::string name = name_entry.word("the name of a standing patch");
    const auto patch = std::find_if(standing.begin(), standing.end(),
                                    [&name](const auto& other) { return other.name == name; });
    if (patch == standing.end()) {
      std::vector<std::string> names;
      for (const StandingPatch& other : standing) names.push_back(other.name);
      name_entry.fail(names.empty() ? "no patch stands at this step, must not release any"
                                    : "must be one of the standing patches: " + joined(names));
    }
    standing.erase(patch);
    step.patches.push_back(name);
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

}  // namespace

std::vector<Step> readSteps(const Entry& entry, const TissueConfig& tissue,
                            const SolverConfig& solver) {
  const Grid grid = filledGrid(tissue).grid;
  std::vector<NodeRange> fixed;
  for (const Box& box : tissue.fixed) fixed.push_back(grid.nodesIn(box));
  std::vector<StandingPatch> standing;
  std::vector<Step> steps;
  for (const Entry& step_entry : entry.list(0, "steps")) {
    const std::string kind = readKind(step_entry);
    const MapReader map(step_entry, kSteps);
    if (kind == "load") {
      steps.push_back(readLoad(map[kind], grid, fixed, solver, standing));
    } else if (kind == "cut") {
      steps.push_back(readCut(map[kind], tissue.spacing));
    } else if (kind == "release") {
      steps.push_back(readRelease(map[kind], standing));
    } else if (kind == "settle") {
      MapReader(map[kind], {});
      steps.push_back(SettleStep());
    } else {
      MapReader(map[kind], {});
      standing.clear();
      steps.push_back(ResetStep());
    }
  }
  return steps;
}

}  // namespace robot_tissue
