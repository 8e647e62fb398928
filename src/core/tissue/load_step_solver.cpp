#include "tissue/load_step_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/split_cells.h"
#include "robot_tissue/core/cells.h"
#include "tissue/kept_still.h"
#include "tissue/solve_total.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

bool isFinite(const Vec3& vector) { return vector.allFinite(); }

bool isAdrift(const PatchAnswer& answer) { return answer.is_adrift; }

bool hasOnlyFiniteNumbers(const SolveReport& report) {
  return std::isfinite(report.residual) && std::isfinite(report.error_estimate) &&
         std::all_of(report.patches.begin(), report.patches.end(), [](const PatchAnswer& patch) {
           return isFinite(patch.force) && isFinite(patch.torque) && isFinite(patch.displacement);
         });
}

}  // namespace

void LoadStepSolver::expectTouch() {
  if (!data_.motion.hasTime()) data_.methods.now().expect(data_.body.state());
}

// The surface is another one: touches are found anew where it is now.
void LoadStepSolver::renewContacts() {
  if (contact_update_ == nullptr) return;
  std::vector<LoadingPatch> of_tools;
  contact_update_->renew(of_tools, ContactUpdate::Shape::kSolved, ContactUpdate::Round::kNext);
  // None, too: those of before may be on ghosts that are gone.
  data_.putToolPatches(std::move(of_tools));
}

SolveReport LoadStepSolver::solve(const std::vector<int>& disturbed) {
  SolveOutcome& outcome = data_.outcome;
  const Patience::LoadStep load_step(data_.bounds.patience());
  outcome.disturb(disturbed);
  SolveReport report = solveAndBreak(outcome.disturbed);
  // What it left, the next time step takes up.
  outcome.is_cut_short = data_.motion.isInTimeStep() && outcome.is_late;
  if (data_.motion.isInTimeStep()) outcome.is_late = false;
  if (!outcome.is_late) outcome.disturbed.clear();
  outcome.forgetGhosts(data_.body.cells());
  // Tools are not to stop for a load that nothing bears: beside them it is told alone.
  if (data_.loads.isUntouched() &&
      std::any_of(report.patches.begin(), report.patches.end(), isAdrift)) {
    outcome.report.status = report.status = std::max(report.status, SolveStatus::kUnconverged);
  }
  outcome.report.volume_ratio = report.volume_ratio = data_.body.volumeRatio();
  return report;
}

// Threads break in balance, one after the other: what one leaves, the others may bear.
SolveReport LoadStepSolver::solveAndBreak(const std::vector<int>& disturbed) {
  SolveReport report = solveInRounds(disturbed);
  if (data_.loads.areComingBack()) return report;
  while (report.status != SolveStatus::kLate && report.status != SolveStatus::kUnconverged) {
    const std::vector<int> left = data_.threads.breakOne(data_.body.displacement());
    if (left.empty()) break;
    SolveTotal total(report);
    report = solveInRounds(left);
    total.addWork(report);
    total.tellWorkIn(report);
    data_.outcome.report = report;
  }
  return report;
}

SolveReport LoadStepSolver::solveOnce(const std::vector<int>& disturbed) {
  SolverMethod& method = data_.methods.now();
  SolveOutcome& outcome = data_.outcome;
  // Where contacts are looked at, the shape is kept in any case; else a copy would cost more than
  // it saves a method that stays finite.
  const bool keeps_shape = contact_update_ != nullptr || !method.staysFinite();
  const Tissue::Displacements last_good = keeps_shape ? data_.body.displacements() : nullptr;
  std::vector<LoadingPatch>& patches = data_.loads.patches();
  const std::vector<LoadingPatch> last_good_patches = patches;
  LatticeState& state = data_.body.change();
  limitWays();
  const double cost = costOfIteration();
  method.limitTime(data_.bounds.mostMs());
  method.limitIterations(data_.bounds.mostIterations(cost));
  KeptStill still(data_);
  SolveReport report = solveWithThreads(disturbed, state);
  still.letGo(report);
  const bool is_finite = hasOnlyFiniteNumbers(report) &&
                         (method.staysFinite() || std::all_of(state.displacement.begin(),
                                                              state.displacement.end(), isFinite));
  if (!is_finite) {
    if (last_good) state.displacement = *last_good;
    patches = last_good_patches;
    report = SolveReport();
    report.status = SolveStatus::kUnconverged;
    report.patches.resize(patches.size());
  }
  outcome.is_late = report.status == SolveStatus::kLate;
  outcome.is_as_solved = is_finite;
  outcome.are_contacts_settled = true;
  noteWork(report, cost);
  describeShape(report);
  outcome.report = report;
  return report;
}

SolveReport LoadStepSolver::solveWithThreads(const std::vector<int>& disturbed,
                                             LatticeState& state) {
  SolverMethod& method = data_.methods.now();
  std::vector<LoadingPatch>& patches = data_.loads.patches();
  if (!data_.threads.act()) return method.solve(patches, disturbed, state);
  patches.push_back(data_.threads.patch());
  SolveReport report = method.solve(patches, disturbed, state);
  patches.pop_back();
  report.patches.resize(patches.size());
  return report;
}

// cost: of an iteration (Patience::note).
void LoadStepSolver::noteWork(const SolveReport& report, double cost) {
  Patience& patience = data_.bounds.patience();
  const bool converged = report.status != SolveStatus::kUnconverged;
  // Loads alone are an answer, however long it took.
  if (converged && data_.loads.isUntouched()) {
    patience.noteEasy();
  } else {
    patience.note(report.iterations, converged, data_.bounds.solved(), cost);
  }
}

void LoadStepSolver::describeShape(SolveReport& report) {
  data_.deformSurface();
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  const GridBox* visited = data_.methods.now().visited();
  report.inverted_cells = visited == nullptr ? countInvertedCells(lattice, state)
                                             : countInvertedCells(lattice, state, *visited);
  if (report.inverted_cells > 0) report.status = SolveStatus::kInverted;
}

// Over that of an iteration with few touches, on a lattice that is whole. Where there are more
// touches than nodes, as of a fine mesh on a coarse lattice, they are most of the work; so are
// cells that cuts parted.
double LoadStepSolver::costOfIteration() const {
  double touches = 0.0;
  for (const LoadingPatch& patch : data_.loads.patches()) {
    touches += static_cast<double>(patch.contacts.size());
  }
  const double nodes = data_.body.lattice().nodeCount();
  const double ghosts = static_cast<double>(data_.body.displacement().size()) - nodes;
  return std::max({1.0, touches / (nodes + ghosts),
                   (nodes + tuning::kNodesOfGhost * ghosts) / std::max(nodes, tuning::kFewNodes)});
}

}  // namespace robot_tissue
