#include "solvers/multigrid/cycle/fas_cg_solver.h"

#include <algorithm>
#include <cmath>

#include "simd/field_kernel.h"

namespace robot_tissue {
namespace {

constexpr int kFewestSteps = 3;            // of the smoother in a cycle
constexpr double kStepsOfRoot = 1.6;       // likewise, of the root of the greatest stiffness
constexpr double kSinglePrecision = 1e-3;  // tolerance that single precision reaches
constexpr int kMostTurns = 20;             // solves, until turning patches have settled
constexpr int kMostRounds = 8;             // of a solve, in wider parts or for what these miss
constexpr double kTurned = 1e-4;           // rad

}  // namespace

template <typename Real>
void FasCgSolver<Real>::forget() {
  factor_ = least_factor_;
  layers_ = firstLayers();
  has_start_ = has_step_ = false;
  loaded_.clear();
  held_ = 0.0;
  missed_ = 0.0;
}

template <typename Real>
void FasCgSolver<Real>::findLevels(const LatticeState& state) {
  if (cells_ == state.cells) return;
  levels_ = std::make_unique<GridHierarchy<Real>>(lattice_, model_, *state.cells, workers_.get());
  cells_ = state.cells;
  has_start_ = has_step_ = false;
  loaded_.clear();
  steps_ = std::max(
      kFewestSteps,
      static_cast<int>(std::lround(kStepsOfRoot * std::sqrt(finest().greatestStiffness()))));
  findLeastFactor(state);
}

template <typename Real>
SolveReport FasCgSolver<Real>::run(ConstrainedState& shape, const DofConstraints& hold,
                                   const std::vector<int>& disturbed, const Budget& budget) {
  findLevels(shape.state);
  findSeeds(shape, hold, disturbed);
  SolveReport report;
  if (seeds_.isEmpty()) return report;
  in_contact_ = !hold.touched().empty();
  const bool changed = in_contact_ || !disturbed.empty();
  cycles_ = 0;
  for (int round = 0; round < kMostTurns; ++round) {
    report.status = solve(shape, hold, changed, budget);
    if (!levels_->isFinite()) return giveUp(shape, hold);
    levels_->writeTo(shape.state.displacement, hold.dirichletMask());
    if (!settlePatches(shape, hold) || report.status != SolveStatus::kOk) break;
  }
  ended_late_ = report.status == SolveStatus::kLate;
  report.iterations = cycles_;
  report.error_estimate = std::isfinite(error_) ? std::hypot(error_, missed_) : 1.0;
  answer(shape, hold, report);
  return report;
}

// As it was when the solve began.
template <typename Real>
SolveReport FasCgSolver<Real>::giveUp(const ConstrainedState& shape, const DofConstraints& hold) {
  prepare(shape, hold);
  has_start_ = has_step_ = false;
  SolveReport report;
  report.status = SolveStatus::kUnconverged;
  report.iterations = cycles_;
  report.error_estimate = 1.0;
  answer(shape, hold, report);
  return report;
}

// In the part around the seeds, in a larger one where it is not smooth beyond that, or in all of it
// where it does not go well.
template <typename Real>
SolveStatus FasCgSolver<Real>::solve(ConstrainedState& shape, const DofConstraints& hold,
                                     bool changed, const Budget& budget) {
  open(shape, hold, aroundSeeds());
  for (int round = 1;; ++round) {
    const bool warm_started = first_of_step_ && has_step_ && greatest_ > 0.0 && warmStart();
    first_of_step_ = false;
    const SolveStatus status = iterate(changed, warm_started, budget);
    if (status == SolveStatus::kUnconverged && !levels_->isWhole()) {
      open(shape, hold, levels_->whole());
    } else if (status == SolveStatus::kOk && raiseLayers()) {
      levels_->writeTo(shape.state.displacement, hold.dirichletMask());
      open(shape, hold, aroundSeeds());
    } else if (status != SolveStatus::kOk || error_ <= allowed() || round > kMostRounds) {
      return status;
    }
  }
}

template <typename Real>
void FasCgSolver<Real>::open(const ConstrainedState& shape, const DofConstraints& hold,
                             const GridBox& box) {
  if (levels_->open(box, static_cast<int>(layers_), shape.state.displacement)) {
    has_start_ = has_step_ = false;
  }
  prepare(shape, hold);
}

template <typename Real>
void FasCgSolver<Real>::prepare(const ConstrainedState& shape, const DofConstraints& hold) {
  levels_->bind(shape, hold);
  levels_->setDisplacement(shape.state.displacement, hold.dirichletMask());
  limited_from_.clear();
  for (const NodeLimit& limit : limits_) {
    limited_from_.push_back(shape.state.displacement[at(limit.node)]);
  }
  if (first_of_step_) noteStep();
  free_nodes_ = hold.freeNodes();
  finest().findForces();
  greatest_ = unbalanced();
}

// Remembers the way of the last step, if anything moved in it.
template <typename Real>
void FasCgSolver<Real>::noteStep() {
  Vector now;
  keepPlace(now);
  if (has_start_ && step_start_.nodes != now.nodes) {
    last_step_ = now;
    step_start_.groups.clear();
    last_step_.groups.clear();
    add(step_start_, -1.0, last_step_);
    has_step_ = true;
  }
  step_start_ = std::move(now);
  has_start_ = true;
}

// Patches by force go where the levels moved them, as rigid bodies do. True: one turned so far that
// its nodes are no longer where they were found to balance.
template <typename Real>
bool FasCgSolver<Real>::settlePatches(ConstrainedState& shape, const DofConstraints& hold) {
  bool any = false, turned = false;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    LoadingPatch& patch = shape.patches[index];
    const GroupVector motion = finest().constrained.motion[index];
    if (!byForce(patch) || motion.isZero(0.0)) continue;
    movePatch(lattice_, patch, lattice_.spacing() * motion.template head<3>(),
              motion.template tail<3>(), shape.state);
    any = true;
    turned = turned || motion.template tail<3>().norm() > kTurned;
  }
  if (!any) return false;
  levels_->renewGroups(shape, hold);
  finest().findForces();
  return turned;
}

template <typename Real>
void FasCgSolver<Real>::answer(const ConstrainedState& shape, const DofConstraints& hold,
                               SolveReport& report) {
  held_ = answerPatches(shape, hold, report);
  double left = unbalanced();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    left = std::max(left, finest().constrained.force[index].template head<3>().norm());
  }
  report.residual = left / std::max({held_, greatest_, kStill});
  report.active_nodes = openNodes(hold);
  report.layers = layersRaised();
}

// The greatest force of a patch on a node, in the levels' units.
template <typename Real>
double FasCgSolver<Real>::answerPatches(const ConstrainedState& shape, const DofConstraints& hold,
                                        SolveReport& report) const {
  const std::vector<Vec3>& displacement = shape.state.displacement;
  const double unit = levels_->modulus() * lattice_.spacing() * lattice_.spacing();
  double held = 0.0;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    std::vector<Vec3> of_hard;
    for (const int node : hold.hardOf(index)) {
      of_hard.push_back(unit * finest().wholeForce(levels_->entryOf(node)));
      held = std::max(held, of_hard.back().norm() / unit);
    }
    for (const RimSpring& spring : patch.rim) {
      const Vec3 stretch = spring.anchor - displacement[at(spring.node)];
      held = std::max(held, (stiffnessOf(patch, spring) * stretch).norm() / unit);
    }
    for (const ContactSpring& spring : patch.contacts) {
      held = std::max(held, forceOf(spring, displacement).norm() / unit);
    }
    report.patches.push_back(answerOf(lattice_, shape.state, patch, of_hard));
  }
  return held;
}

std::unique_ptr<MultigridSolver> makeMultigridSolver(const Lattice& lattice,
                                                     const ElasticModel& model,
                                                     const LayeredOptions& options) {
  if (options.tolerance >= kSinglePrecision) {
    return std::make_unique<FasCgSolver<float>>(lattice, model, options);
  }
  return std::make_unique<FasCgSolver<double>>(lattice, model, options);
}

template class FasCgSolver<float>;
template class FasCgSolver<double>;

}  // namespace robot_tissue
