#include "tissue/load_program.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "base/text_of.h"
#include "loads/patch_rim.h"
#include "material/tissue_model.h"
#include "tissue/solve_total.h"

namespace robot_tissue {
namespace {

[[noreturn]] void refusePatch(const std::string& patch, const std::string& problem,
                              const std::string& allowed) {
  throw InputError("patch '" + patch + "': " + problem + "; allowed: " + allowed);
}

// How far patches may be moved at once, beside how large the tissue is at rest.
std::string wayText(double way, const Box& tissue) {
  std::ostringstream text;
  text.precision(3);
  text << way << " m at once (the tissue is " << tissue.sizes().x() << " x " << tissue.sizes().y()
       << " x " << tissue.sizes().z() << " m)";
  return text.str();
}

// A node obeys one patch. A load that a removal took nodes from has them again where they are there
// again: by the box that it had.
void requireOwnNodes(const std::vector<LoadingPatch>& patches,
                     const std::vector<LoadingPatch>& standing) {
  std::unordered_map<int, const LoadingPatch*> owners;
  const auto claim = [&](const LoadingPatch& patch) {
    for (const int node : patch.nodes) {
      const LoadingPatch*& owner = owners[node];
      if (owner != nullptr && (owner->tool || owner->name != patch.name)) {
        if (owner->tool) {
          refusePatch(patch.name, "it shares nodes with what tool '" + owner->name + "' holds",
                      "a box beside that, or a load after the tool has let go");
        }
        refusePatch(patch.name, "it shares nodes with patch '" + owner->name + "'",
                    "patches without a common node");
      }
      owner = &patch;
    }
  };
  for (const LoadingPatch& patch : standing) {
    const auto replaced = std::find_if(patches.begin(), patches.end(), [&](const auto& other) {
      return !patch.tool && other.name == patch.name;
    });
    const auto has_all_of = [&](const std::vector<int>& nodes) {
      return std::includes(replaced->nodes.begin(), replaced->nodes.end(), nodes.begin(),
                           nodes.end());
    };
    if (replaced == patches.end()) {
      claim(patch);
    } else if (!has_all_of(patch.nodes)) {
      refusePatch(patch.name, "a patch of this name stands on nodes outside of its box",
                  "a box that holds these, too, or a release");
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

// The center of a patch that turns is that of its nodes at rest.
void driveByForce(const PatchConfig& config, const Lattice& lattice, bool may_turn,
                  LoadingPatch& patch) {
  patch.drive = LoadingPatch::Drive::kForce;
  patch.force = *config.force;
  if (config.turns && !may_turn) {
    refusePatch(config.name, "turns: this method moves patches without turning them",
                "turns false, or another method");
  }
  if (config.turns && areOnALine(lattice, patch.nodes)) {
    refusePatch(config.name, "turns: its nodes are on a line, which nothing keeps from turning",
                "turns false, or a box of nodes on more than one line");
  }
  patch.turns = config.turns;
  patch.center = restCenter(lattice, patch.nodes);
}

void driveByDisplacement(const PatchConfig& config, LoadingPatch& patch) {
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

void LoadProgram::load(const LoadStep& step, const Tissue::OnIncrement& on_increment,
                       int most_increments) {
  std::vector<LoadingPatch> targets;
  for (const PatchConfig& config : step.patches) targets.push_back(makePatch(config));
  requireOwnNodes(targets, data_.loads.patches());
  const Tissue::Shape before = data_.shape();
  const TissueMotion::Standstill stands(data_.motion);
  std::vector<LoadRamp> ramps;
  for (const LoadingPatch& target : targets) {
    ramps.push_back(makeRamp(target, data_.loads.find(target.name)));
  }
  const int increments = step.increments.value_or(wholeParts(stepping_.foreseenSteps(ramps)));
  if (increments > most_increments) {
    const bool was_as_solved = data_.outcome.is_as_solved;
    data_.restore(before);
    data_.outcome.is_as_solved = was_as_solved;
    const bool by_force = std::any_of(targets.begin(), targets.end(), byForce);
    const std::string most = "at most " + std::to_string(most_increments) + ", so ";
    const double way = most_increments * data_.methods.now().patchStep();
    refusePatch(targets.front().name,
                "the load needs " + std::to_string(increments) + " increments",
                most + (by_force ? "a smaller load" : wayText(way, data_.body.lattice().bounds())));
  }
  data_.history.noteOtherLoads();
  for (const LoadRamp& ramp : ramps) data_.loads.dropDue(ramp.target.name);
  placeStarts(ramps);
  // A support that it rests on holds it from the first on.
  if (data_.loads.isUntouched()) solver_.renewContacts();
  if (step.increments) {
    stepping_.stepLoads(ramps, increments, on_increment);
  } else {
    stepping_.stepLoadsByItself(ramps, on_increment);
  }
}

void LoadProgram::placeStarts(std::vector<LoadRamp>& ramps) {
  for (LoadRamp& ramp : ramps) {
    const LoadingPatch* standing = data_.loads.find(ramp.target.name);
    if (standing != nullptr && byForce(ramp.target) && standing->nodes != ramp.target.nodes) {
      layNewNodes(*standing, ramp.start);
    }
    ramp.patch = data_.loads.place(ramp.start);
  }
  leaveRimsToOwners(data_.loads.patches());
}

// Nodes that the patch did not hold so far, as a removal took them and they are there again, go
// where its other nodes have them: it is one hard piece.
void LoadProgram::layNewNodes(const LoadingPatch& standing, LoadingPatch& start) const {
  const Lattice& lattice = data_.body.lattice();
  const Eigen::Matrix3d& rotation = standing.place.rotation;
  LatticeState& state = data_.body.change();
  const std::vector<Vec3> own = ownDisplacement(standing, state.displacement);
  Vec3 shift = Vec3::Zero();
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Vec3 rest = lattice.restPosition(standing.nodes[i]);
    shift += (rest + own[i] - rotation * rest) / static_cast<double>(own.size());
  }
  const auto laid = [&](int node) -> Vec3 {
    const Vec3 rest = lattice.restPosition(node);
    return rotation * rest + shift - rest;
  };
  const auto has = [](const auto& nodes, int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
  for (const int node : start.nodes) {
    if (!has(standing.nodes, node)) state.displacement[at(node)] = laid(node);
  }
  std::vector<int> rim_before;
  for (const RimSpring& spring : standing.rim) rim_before.push_back(spring.node);
  for (RimSpring& spring : start.rim) {
    if (!has(rim_before, spring.node)) spring.anchor = laid(spring.node);
  }
}

void LoadProgram::loadOn(const Tissue::OnIncrement& on_increment) {
  if (!data_.loads.isLoading()) return;
  const TissueMotion::Standstill stands(data_.motion);
  std::vector<LoadRamp> ramps;
  for (const LoadingPatch& target : data_.loads.takeDue()) {
    const LoadingPatch* standing = data_.loads.find(target.name);
    if (standing != nullptr) ramps.push_back(makeRamp(target, standing));
  }
  if (ramps.empty()) return;
  placeStarts(ramps);
  endComingBack(stepping_.stepLoadsByItself(ramps, on_increment));
}

SolveReport LoadProgram::release(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (data_.loads.find(name) == nullptr) {
      refusePatch(name, "no standing patch has this name", "the name of a patch that was loaded");
    }
  }
  data_.history.noteOtherLoads();
  for (const std::string& name : std::set<std::string>(names.begin(), names.end())) {
    const std::size_t number = *data_.loads.numberOf(name);
    std::vector<PatchAnswer>& answers = data_.outcome.report.patches;
    if (number < answers.size()) {
      answers.erase(answers.begin() + static_cast<std::ptrdiff_t>(number));
    }
    data_.loads.remove(number);
  }
  if (data_.motion.takesNoTime()) return data_.asItIs();
  const bool unique = data_.methods.now().findsEquilibrium() && !data_.loads.isUntouched();
  unique ? solver_.solve(data_.body.freeNodes()) : solveFromRest();
  return surgery_.tear();
}

SolveReport LoadProgram::follow(std::vector<LoadingPatch> tool_patches,
                                const std::vector<int>& disturbed, Bedding bedding) {
  const bool one_left = data_.loads.isOneLeftBy(tool_patches);
  data_.putToolPatches(std::move(tool_patches));
  const bool last_left = one_left && data_.loads.isUntouched();
  const bool returns = data_.methods.now().findsEquilibrium() && bedding == Bedding::kFixedNodes;
  if (data_.motion.isInTimeStep()) return solver_.solve(disturbed);
  if (data_.motion.isInTime()) return data_.asItIs();
  const bool from_rest = data_.methods.now().findsEquilibrium() ? last_left && returns : one_left;
  if (from_rest) return solveFromRest();
  const bool one_there = !data_.loads.isUntouched();
  const SolveReport report = solver_.solve(disturbed);
  // The tissue left the last tool behind in the solve.
  const bool one_lost = one_there && data_.loads.isUntouched();
  return one_lost && returns ? solveFromRest() : report;
}

SolveReport LoadProgram::settle() {
  const TissueMotion::Standstill stands(data_.motion);
  solver_.solve(data_.body.freeNodes());
  return surgery_.tear();
}

// Without a load the rest shape is the equilibrium that every path ends in. The six-spring lattice
// holds sheared shapes without a force, so relaxing back from a deformed shape would not find it.
// Of a piece that nothing holds it is wherever that is; what is adrift stays as it is.
SolveReport LoadProgram::solveFromRest() {
  StandingLoads& loads = data_.loads;
  const std::vector<LoadingPatch> standing = loads.patches();
  const PieceRegistry::Adrift adrift = data_.adrift();
  data_.methods.now().forget();
  loads.beginComingBack();
  relax(adrift.nodes);
  SolveReport report;
  const bool sutured = data_.threads.anyWhole();
  if (data_.body.hasBodyLoad() || sutured) {
    const std::size_t named = loads.named();
    loads.restore({}, 0);
    report = settleFromRest();
    loads.putBack(standing, named);
  }
  std::vector<LoadRamp> ramps;
  for (std::size_t patch = 0; patch < standing.size(); ++patch) {
    ramps.push_back(makeRamp(standing[patch], nullptr));
    ramps.back().patch = patch;
    ramps.back().start.force.setZero();
    const bool stays = std::binary_search(adrift.patches.begin(), adrift.patches.end(), patch);
    if (stays) ramps.back().start.place = standing[patch].place;
    loads.patches()[patch] = ramps.back().start;
  }
  if (!ramps.empty()) {
    report = stepping_.stepLoadsByItself(ramps, {});
  } else if (!data_.body.hasBodyLoad() && !sutured) {
    solver_.describeShape(report);
    report.volume_ratio = data_.body.volumeRatio();
    data_.outcome.report = report;
    data_.outcome.is_late = false;
  }
  return endComingBack(report);
}

// The loads stand again, or are due: once they do, what they leave too much for breaks and tears.
SolveReport LoadProgram::endComingBack(SolveReport report) {
  if (!data_.loads.areComingBack() || data_.loads.isLoading()) return report;
  data_.loads.endComingBack();
  const bool in_balance =
      report.status != SolveStatus::kLate && report.status != SolveStatus::kUnconverged;
  if (in_balance && data_.threads.isOneOver(data_.body.displacement())) {
    SolveTotal total(report);
    report = solver_.solve(data_.threads.nodes());
    total.add(report);
    total.tellIn(report);
    data_.outcome.report = report;
  }
  if (data_.loads.patches().empty()) return report;
  SolveTotal total(report);
  report = surgery_.tear();
  total.worsen(report.status);
  report.status = total.worst;
  return report;
}

void LoadProgram::relax(const std::vector<int>& but_for) {
  std::vector<Vec3> relaxed = data_.pieces.relaxed();
  for (const int node : but_for) relaxed[at(node)] = data_.body.displacement()[at(node)];
  data_.body.change().displacement = std::move(relaxed);
}

// Under gravity and threads alone, these drawn in from where the rest shape has their ends. A shape
// on the way to another: what loads hold is not let go of, and nothing tears of it.
SolveReport LoadProgram::settleFromRest() {
  SolveReport report;
  data_.threads.loosen(data_.body.displacement());
  if (data_.body.hasBodyLoad()) {
    data_.motion.stop();
    report = solver_.solve(data_.body.freeNodes());
  }
  return data_.threads.anyWhole() ? suturing_.drawThreadsIn() : report;
}

LoadingPatch LoadProgram::makePatch(const PatchConfig& config) const {
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  LoadingPatch patch;
  patch.name = config.name;
  patch.nodes = lattice.nodesIn(config.box);
  patch.nodes.erase(std::remove_if(patch.nodes.begin(), patch.nodes.end(),
                                   [&](int node) { return isRemoved(state, node); }),
                    patch.nodes.end());
  if (patch.nodes.empty())
    refusePatch(config.name, "no node in its box, " + textOf(config.box) + " m",
                "a box that holds a node");
  if (std::any_of(patch.nodes.begin(), patch.nodes.end(),
                  [&](int node) { return lattice.isFixed(node); })) {
    refusePatch(config.name, "its box holds fixed nodes", "a box of free nodes");
  }
  if (data_.methods.now().findsEquilibrium()) {
    patch.rim = rimOf(lattice, data_.body.model(), state, config.box, patch.nodes);
  }
  if (config.force) {
    driveByForce(config, lattice, data_.methods.now().findsEquilibrium(), patch);
  } else {
    driveByDisplacement(config, patch);
  }
  return patch;
}

// Starts where the patch stands, or where the nodes of a new one are, with the force it finds.
LoadRamp LoadProgram::makeRamp(const LoadingPatch& target, const LoadingPatch* standing) const {
  LoadRamp ramp;
  ramp.target = target;
  ramp.start = target;
  const std::vector<Vec3>& displacement = data_.body.displacement();
  for (RimSpring& spring : ramp.start.rim) spring.anchor = displacement[at(spring.node)];
  ramp.start.place = PatchPlace();
  if (standing != nullptr) {
    for (RimSpring& spring : ramp.start.rim) {
      for (const RimSpring& earlier : standing->rim) {
        if (earlier.node == spring.node) spring.anchor = earlier.anchor;
      }
    }
    if (standing->drive == target.drive) ramp.start.place = placeAbout(target.center, *standing);
  }
  if (byForce(target)) {
    ramp.start.force = patchForce(ramp.start);
    return ramp;
  }
  ramp.start.displacement = ownDisplacement(ramp.start, displacement);
  return ramp;
}

Vec3 LoadProgram::patchForce(const LoadingPatch& patch) const {
  const LatticeState& state = data_.body.state();
  std::vector<Vec3> forces(state.displacement.size(), Vec3::Zero());
  for (const int node : patch.nodes) forces[at(node)] = forces_.nodeForce(node);
  for (const LoadingPatch& other : data_.loads.patches()) {
    addContactForces(other, state.displacement, forces);
  }
  return answerOf(data_.body.lattice(), state, patch, onHardNodes(patch, forces)).force;
}

}  // namespace robot_tissue
