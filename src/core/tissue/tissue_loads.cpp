// Tissue: named loading patches and the way to their loads.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "loads/patch_rim.h"
#include "material/tissue_model.h"
#include "solvers/solver_method.h"
#include "tissue/load_ramp.h"
#include "tissue/tissue_parts.h"

namespace robot_tissue {
namespace {

[[noreturn]] void refusePatch(const std::string& patch, const std::string& problem,
                              const std::string& allowed) {
  throw InputError("patch '" + patch + "': " + problem + "; allowed: " + allowed);
}

// Or at one place.
bool areOnALine(const Lattice& lattice, const std::vector<int>& nodes) {
  const auto place = [&](int node) -> Eigen::Vector3i {
    const auto index = lattice.gridIndex(node);
    return {index[0], index[1], index[2]};
  };
  const Eigen::Vector3i first = place(nodes.front()), way = place(nodes.back()) - first;
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](int node) { return (place(node) - first).cross(way).isZero(); });
}

// A node obeys one patch.
void requireOwnNodes(const std::vector<LoadingPatch>& patches,
                     const std::vector<LoadingPatch>& standing) {
  std::unordered_map<int, const LoadingPatch*> owners;
  const auto claim = [&](const LoadingPatch& patch) {
    for (const int node : patch.nodes) {
      const LoadingPatch*& owner = owners[node];
      if (owner != nullptr && owner->name != patch.name) {
        refusePatch(patch.name, "it shares nodes with patch '" + owner->name + "'",
                    "patches without a common node");
      }
      owner = &patch;
    }
  };
  for (const LoadingPatch& patch : standing) {
    const auto replaced = std::find_if(patches.begin(), patches.end(),
                                       [&](const auto& other) { return other.name == patch.name; });
    if (replaced == patches.end()) {
      claim(patch);
    } else if (replaced->nodes != patch.nodes) {
      refusePatch(patch.name, "a patch of this name stands on other nodes",
                  "the same box, or a release");
    }
  }
  std::set<std::string> names;
  for (const LoadingPatch& patch : patches) {
    if (!names.insert(patch.name).second) {
      refusePatch(patch.name, "two patches of this load have this name", "a name for each patch");
    }
    claim(patch);
  }
}

std::string textOf(const Box& box) {
  std::ostringstream text;
  text << "(" << box.min().x() << ", " << box.min().y() << ", " << box.min().z() << ") to ("
       << box.max().x() << ", " << box.max().y() << ", " << box.max().z() << ") m";
  return text.str();
}

// Where a patch's rim reaches nodes of another one, these are the other's alone.
void leaveRimsToOwners(std::vector<LoadingPatch>& patches) {
  std::unordered_map<int, const LoadingPatch*> owners;
  for (const LoadingPatch& patch : patches) {
    for (const int node : patch.nodes) owners[node] = &patch;
  }
  for (LoadingPatch& patch : patches) {
    const auto foreign = [&](const RimSpring& spring) {
      const auto owner = owners.find(spring.node);
      return owner != owners.end() && owner->second != &patch;
    };
    patch.rim.erase(std::remove_if(patch.rim.begin(), patch.rim.end(), foreign), patch.rim.end());
  }
}

}  // namespace

void TissueParts::load(const LoadStep& step, const OnIncrement& on_increment, int most_increments) {
  std::vector<LoadingPatch> targets;
  for (const PatchConfig& config : step.patches) targets.push_back(makePatch(config));
  requireOwnNodes(targets, loads_.patches());
  const Shape before = shape();
  motion_.stop();
  std::vector<LoadRamp> ramps;
  for (const LoadingPatch& target : targets) {
    ramps.push_back(makeRamp(target, loads_.find(target.name)));
  }
  const int increments = step.increments.value_or(wholeParts(foreseenSteps(ramps)));
  if (increments > most_increments) {
    restore(before);
    refusePatch(targets.front().name,
                "the load needs " + std::to_string(increments) + " increments",
                "at most " + std::to_string(most_increments) + ", so a smaller load");
  }
  for (LoadRamp& ramp : ramps) {
    loads_.dropDue(ramp.target.name);
    ramp.patch = loads_.place(ramp.start);
  }
  leaveRimsToOwners(loads_.patches());
  if (isUntouched()) renewContacts();  // a support that it rests on holds it from the first on
  if (step.increments) {
    stepLoads(ramps, increments, on_increment);
  } else {
    stepLoadsByItself(ramps, on_increment);
  }
}

void TissueParts::loadOn(const OnIncrement& on_increment) {
  if (!loads_.isLoading()) return;
  motion_.stop();
  std::vector<LoadRamp> ramps;
  for (const LoadingPatch& target : loads_.takeDue()) {
    const LoadingPatch* standing = loads_.find(target.name);
    if (standing != nullptr) ramps.push_back(makeRamp(target, standing));
  }
  if (ramps.empty()) return;
  for (LoadRamp& ramp : ramps) ramp.patch = loads_.place(ramp.start);
  leaveRimsToOwners(loads_.patches());
  stepLoadsByItself(ramps, on_increment);
}

SolveReport TissueParts::release(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (loads_.find(name) == nullptr) {
      refusePatch(name, "no standing patch has this name", "the name of a patch that was loaded");
    }
  }
  for (const std::string& name : std::set<std::string>(names.begin(), names.end())) {
    const std::size_t number = *loads_.numberOf(name);
    std::vector<PatchAnswer>& answers = outcome_.report.patches;
    if (number < answers.size()) {
      answers.erase(answers.begin() + static_cast<std::ptrdiff_t>(number));
    }
    loads_.remove(number);
  }
  if (motion_.takesNoTime()) return asItIs();
  const bool unique = methods_.now().findsEquilibrium() && !isUntouched();
  unique ? solve(body_.freeNodes()) : solveFromRest();
  return tear();
}

PatchAnswer TissueParts::answerOf(const std::string& name, const SolveReport& report) const {
  const std::optional<std::size_t> number = loads_.numberOf(name);
  return number && *number < report.patches.size() ? report.patches[*number] : PatchAnswer();
}

LoadingPatch TissueParts::makePatch(const PatchConfig& config) const {
  LoadingPatch patch;
  patch.name = config.name;
  patch.nodes = body_.lattice().nodesIn(config.box);
  patch.nodes.erase(std::remove_if(patch.nodes.begin(), patch.nodes.end(),
                                   [this](int node) { return isRemoved(body_.state(), node); }),
                    patch.nodes.end());
  if (patch.nodes.empty())
    refusePatch(config.name, "no node in its box, " + textOf(config.box),
                "a box that holds a node");
  if (std::any_of(patch.nodes.begin(), patch.nodes.end(),
                  [this](int node) { return body_.lattice().isFixed(node); })) {
    refusePatch(config.name, "its box holds fixed nodes", "a box of free nodes");
  }
  if (methods_.now().findsEquilibrium()) {
    patch.rim = rimOf(body_.lattice(), body_.model(), body_.state(), config.box, patch.nodes);
  }
  if (config.force) {
    patch.drive = LoadingPatch::Drive::kForce;
    patch.force = *config.force;
    if (config.turns && !methods_.now().findsEquilibrium()) {
      refusePatch(config.name, "turns: this method moves patches without turning them",
                  "turns false, or another method");
    }
    if (config.turns && areOnALine(body_.lattice(), patch.nodes)) {
      refusePatch(config.name, "turns: its nodes are on a line, which nothing keeps from turning",
                  "turns false, or a box of nodes on more than one line");
    }
    patch.turns = config.turns;
    for (const int node : patch.nodes) {
      patch.center += body_.lattice().restPosition(node) / static_cast<double>(patch.nodes.size());
    }
    return patch;
  }
  Vec3 displacement = Vec3::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double>& component = (*config.displacement)[axis];
    patch.free_axis[axis] = !component;
    displacement[static_cast<Eigen::Index>(axis)] = component.value_or(0.0);
  }
  patch.displacement.assign(patch.nodes.size(), displacement);
  for (RimSpring& spring : patch.rim) {
    spring.anchor = displacement;
    for (int axis = 0; axis < 3; ++axis) {
      if (patch.free_axis[at(axis)]) spring.stiffness[axis] = 0.0;
    }
  }
  return patch;
}

// Starts where the patch stands, or where the nodes of a new one are, with the force it finds.
LoadRamp TissueParts::makeRamp(const LoadingPatch& target, const LoadingPatch* standing) const {
  LoadRamp ramp;
  ramp.target = target;
  ramp.start = target;
  for (RimSpring& spring : ramp.start.rim) spring.anchor = body_.displacement()[at(spring.node)];
  ramp.start.place = PatchPlace();
  if (standing != nullptr) {
    for (RimSpring& spring : ramp.start.rim) {
      for (const RimSpring& earlier : standing->rim) {
        if (earlier.node == spring.node) spring.anchor = earlier.anchor;
      }
    }
    if (standing->drive == target.drive) ramp.start.place = standing->place;
  }
  if (byForce(target)) {
    ramp.start.force = patchForce(ramp.start);
    return ramp;
  }
  ramp.start.displacement = ownDisplacement(ramp.start, body_.displacement());
  return ramp;
}

Vec3 TissueParts::patchForce(const LoadingPatch& patch) const {
  std::vector<Vec3> forces(body_.displacement().size(), Vec3::Zero());
  for (const int node : patch.nodes) forces[at(node)] = nodeForce(node);
  for (const LoadingPatch& other : loads_.patches())
    addContactForces(other, body_.displacement(), forces);
  return robot_tissue::answerOf(body_.lattice(), body_.state(), patch, onHardNodes(patch, forces))
      .force;
}

}  // namespace robot_tissue
