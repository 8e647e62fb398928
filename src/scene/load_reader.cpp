// A load step: rigid patches, each on nodes of its own.
#include <algorithm>

#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/patch_name.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

bool sameNodes(const NodeRange& a, const NodeRange& b) {
  return a.first == b.first && a.last == b.last;
}

std::string readPatchName(const Entry& entry) {
  const std::string name = entry.word("a name");
  const std::string fault = patchNameFault(name);
  if (!fault.empty()) entry.fail(fault);
  return name;
}

std::array<std::optional<double>, 3> readDisplacement(const Entry& entry, const Range& range) {
  const std::string allowed = "must be a list of 3 entries, each a number in m or the word free";
  if (!entry.node().IsSequence() || entry.node().size() != 3) entry.fail(allowed);
  std::array<std::optional<double>, 3> displacement;
  const std::vector<Entry> components = entry.list(3, "numbers");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (components[axis].isWord("free")) continue;
    const YAML::Node& node = components[axis].node();
    if (!node.IsScalar() || !parseNumber(node.Scalar())) {
      components[axis].fail("must be a number in m or the word free");
    }
    displacement[axis] = components[axis].number(range);
  }
  if (std::none_of(displacement.begin(), displacement.end(),
                   [](const auto& component) { return component.has_value(); })) {
    entry.fail("must have at least one number, all three are free");
  }
  return displacement;
}

void readDrive(const MapReader& map, const Range& range, PatchConfig& patch) {
  const Entry displacement = map["displacement"];
  const Entry force = map["force"];
  if (displacement.given() == force.given()) {
    map.entry().fail(std::string(force.given() ? "has both" : "has neither of") +
                     " displacement and force, must have exactly one");
  }
  if (force.given()) {
    patch.force = readVector(force, ranges::force(), ranges::kLeastForce);
  } else {
    patch.displacement = readDisplacement(displacement, range);
  }
}

struct PatchReading {
  const SolverConfig& solver;
  PatchConfig patch;
};

// Only what a force moves may also turn until no moment is left.
void readTurns(const Entry& entry, PatchReading& reading) {
  if (!entry.given()) return;
  PatchConfig& patch = reading.patch;
  const SolverConfig& solver = reading.solver;
  patch.turns = entry.truth();
  if (patch.turns && !patch.force) entry.fail("the patch has a displacement, must have a force");
  if (patch.turns && !traitsOf(solver.method).turns_patches) {
    entry.fail("method " + solver.method +
               " moves patches without turning them, must be false or left out");
  }
}

const KeyTable<PatchReading> kPatchKeys = {
    {"name",
     [](const Entry& entry, PatchReading& reading) { reading.patch.name = readPatchName(entry); }},
    {"min"},
    {"max"},
    {"displacement"},
    {"force"},
    {"turns", readTurns},
};

PatchConfig readPatch(const Entry& entry, const Grid& grid, const SolverConfig& solver,
                      const Range& displacement) {
  const MapReader map(entry, namesOf(kPatchKeys));
  PatchReading reading{solver, {}};
  reading.patch.box = readNodeBox(map, grid);
  readDrive(map, displacement, reading.patch);
  readKeys(map, kPatchKeys, reading);
  return reading.patch;
}

const KeyTable<LoadStep> kLoadKeys = {
    {"increments",
     [](const Entry& entry, LoadStep& step) {
       if (entry.given()) step.increments = entry.integer(1, kMostIncrements);
     }},
    {"patches"},
};

// Refuses patches whose nodes are fixed, or of a patch that stands already.
void checkNodes(const Entry& entry, const Grid& grid, const StandingPatch& patch,
                const std::vector<NodeRange>& fixed, const std::vector<StandingPatch>& standing) {
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!grid.shareNode(patch.nodes, fixed[i])) continue;
    entry.fail("the patch holds nodes of tissue.fixed[" + std::to_string(i) +
               "], must hold only nodes that can move");
  }
  for (const StandingPatch& other : standing) {
    if (other.name == patch.name && !sameNodes(other.nodes, patch.nodes)) {
      entry.fail("patch " + patch.name +
                 " stands on other nodes, must be released first or keep its box");
    }
    if (other.name != patch.name && grid.shareNode(other.nodes, patch.nodes)) {
      entry.fail("the patch shares nodes with standing patch " + other.name +
                 ", must have nodes of its own");
    }
  }
}

}  // namespace

LoadStep readLoad(const Entry& entry, const Grid& grid, const std::vector<NodeRange>& fixed,
                  const SolverConfig& solver, const Range& displacement,
                  std::vector<StandingPatch>& standing) {
  const MapReader map(entry, namesOf(kLoadKeys));
  LoadStep step;
  readKeys(map, kLoadKeys, step);
  std::vector<std::string> names;
  for (const Entry& patch_entry : map["patches"].list(1, "patches")) {
    const PatchConfig patch = readPatch(patch_entry, grid, solver, displacement);
    if (std::find(names.begin(), names.end(), patch.name) != names.end()) {
      const MapReader map_of_patch(patch_entry, namesOf(kPatchKeys));
      map_of_patch["name"].fail("an earlier patch of this load has the name, must be unique");
    }
    names.push_back(patch.name);
    const StandingPatch stands{patch.name, grid.nodesIn(patch.box)};
    checkNodes(patch_entry, grid, stands, fixed, standing);
    const bool again = std::any_of(standing.begin(), standing.end(),
                                   [&](const auto& other) { return other.name == patch.name; });
    if (!again) standing.push_back(stands);
    step.patches.push_back(patch);
  }
  return step;
}

}  // namespace robot_tissue
