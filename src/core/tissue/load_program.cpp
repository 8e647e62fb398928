#include "tissue/load_program.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "tissue/refused_patch.h"
#include "tissue/solve_total.h"

namespace robot_tissue {
namespace {

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

}  // namespace

void LoadProgram::load(const LoadStep& step, const Tissue::OnIncrement& on_increment,
                       int most_increments) {
  if (step.patches.empty()) throw InputError("a load without a patch; allowed: one patch or more");
  std::vector<LoadingPatch> targets;
  for (const PatchConfig& config : step.patches) targets.push_back(makePatch(config));
  requireOwnNodes(targets, data_.loads.patches());
  const Tissue::Shape before = data_.shape();
  const TissueMotion::Standstill stands(data_.motion);
  std::vector<LoadRamp> ramps = rampsTo(targets);
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
  for (const PatchConfig& config : step.patches) data_.history.noteBox(config.name, config.box);
  if (comesToBalanceBefore(targets)) ramps = rampsTo(targets);
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
  if (from_rest) return comeBackFromTools();
  const bool one_there = !data_.loads.isUntouched();
  const SolveReport report = solver_.solve(disturbed);
  // The tissue left the last tool behind in the solve.
  const bool one_lost = one_there && data_.loads.isUntouched();
  return one_lost && returns ? comeBackFromTools() : report;
}

// Tissue does not go the way from rest: a tool that it left is not in that way, or it would hold up
// each solve that takes a node past it. The shape that the way ends in may touch it again.
SolveReport LoadProgram::comeBackFromTools() {
  const bool acts_any =
      data_.body.hasBodyLoad() || data_.threads.anyWhole() || !data_.loads.patches().empty();
  SolveReport report;
  {
    const LoadStepSolver::NoContacts alone(solver_);
    report = solveFromRest();
  }
  if (!acts_any || data_.loads.areComingBack()) return report;
  solver_.renewContacts();
  if (data_.loads.isUntouched()) return report;
  SolveTotal total(report);
  report = solver_.solve({});
  total.add(report);
  total.tellIn(report);
  data_.outcome.report = report;
  return report;
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

}  // namespace robot_tissue
