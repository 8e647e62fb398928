#include "solvers/multigrid/cycle/fas_cg_iteration.h"

#include <algorithm>

#include "solvers/multigrid/cycle/trial_at_rest.h"
#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

}  // namespace

template <typename Real>
FasCgIteration<Real>::FasCgIteration(const On& on, const LayeredOptions& options)
    : shape_(on.shape),
      part_(on.part),
      limits_(on.limits),
      forces_(on.forces),
      options_(options),
      cycle_(on.shape, options.line_step),
      estimator_(on.shape) {}

template <typename Real>
void FasCgIteration<Real>::resetOnTrial(const Lattice& lattice, const ElasticModel& model,
                                        const LatticeState& state, double known) {
  cycle_.reset();
  estimator_.factor.restart(leastErrorFactor(shape_, lattice, model, state, cycle_.smootherSteps()),
                            known);
}

template <typename Real>
SolveStatus FasCgIteration<Real>::run(SolveContext& solve) {
  estimator_.begin();
  progress_.begin();
  cycle_.begin();
  shape_.levels().coupleMembranes(false);
  shape_.levels().relieve(is_bent_ && shape_.levels().isWhole());
  SolveStatus status = check(solve);
  double began_ms = solve.budget.elapsedMs();
  for (; status == SolveStatus::kLate; status = check(solve)) {
    const double now_ms = solve.budget.elapsedMs();
    if (solve.cycles > 0 && solve.budget.isSpentFor(now_ms - began_ms)) break;
    began_ms = now_ms;
    if (areMembranesStiff(solve)) shape_.levels().coupleMembranes(true);
    const bool is_easy = isEasy(solve);
    const double rough = is_easy ? shape_.finest().squaredLocalMotion() : 0.0;
    makeCycle(solve);
    ++solve.cycles;
    if (is_easy && isQuiet(rough)) {
      estimator_.noteCorrection();
      return SolveStatus::kOk;
    }
    if (isPowerOfTwo(solve.cycles)) shape_.renewMembranes();
  }
  if (status == SolveStatus::kLate) finishLate(solve);
  // What is in balance stays, bit for bit.
  const bool moves =
      solve.cycles > 0 || solve.warm_started || estimator_.error() > options_.tolerance;
  if (status == SolveStatus::kOk && moves && estimator_.left().now > 0.0) finish(solve);
  // What slips has more left on its way: only a shape that blew up goes back.
  if (status == SolveStatus::kUnconverged && !estimator_.left().isWithin(tuning::kBlownUp)) {
    shape_.restore(progress_.bestPlaces());
    estimator_.noteError(progress_.bestError());
  }
  return status;
}

// A cycle shows it that gets on slowly. Alone, nodes of a membrane take cheaper steps, and, where a
// tool slides over it, better ones: together they go as far as the loosest of them may.
template <typename Real>
bool FasCgIteration<Real>::areMembranesStiff(const SolveContext& solve) const {
  return solve.cycles > 0 && !solve.in_contact && estimator_.left().isAbove(tuning::kSlow);
}

// Cycles show it that coarse levels lead astray, as where tissue is bent far: they hardly find less
// to move than at the start. From then on coarse cells have relief, in further solves, too. In
// contact cycles are slow for other reasons.
template <typename Real>
bool FasCgIteration<Real>::isBent(const SolveContext& solve) const {
  return !is_bent_ && !solve.in_contact && solve.cycles >= tuning::kCyclesBeforeRelief &&
         shape_.levels().isWhole() && !estimator_.left().isWithin(tuning::kLeadsAstray);
}

// Where the solve stands: kLate while there is hope.
template <typename Real>
SolveStatus FasCgIteration<Real>::check(const SolveContext& solve) {
  if (isBent(solve)) {
    is_bent_ = true;
    shape_.levels().relieve(true);
  }
  shape_.levels().correction().find();
  estimator_.update(solve, cycle_);
  progress_.note(solve, estimator_, shape_);
  if (solve.cycles == 0 && forces_.isZero()) {
    estimator_.noteRest();
    return SolveStatus::kOk;
  }
  if (isBalanced(solve)) return SolveStatus::kOk;
  return isHopeless(solve) ? SolveStatus::kUnconverged : SolveStatus::kLate;
}

template <typename Real>
bool FasCgIteration<Real>::isBalanced(const SolveContext& solve) const {
  const bool untried = solve.cycles == 0 && solve.has_changed;
  return !untried && estimator_.errorAfterCorrection() <= part_.allowedError() &&
         forces_.isReached(solve);
}

// A tool in contact went on as before, and the warm start with it: the one cycle that a change asks
// for is expected to be all.
template <typename Real>
bool FasCgIteration<Real>::isEasy(const SolveContext& solve) const {
  return solve.in_contact && !solve.in_time && solve.warm_started && solve.cycles == 0 &&
         estimator_.errorAfterCorrection() <= part_.allowedError() && forces_.isReached(solve);
}

// That cycle did what was expected: the smooth motion that is left need not be found to see it.
// rough_before: GridLevel::squaredLocalMotion before it.
template <typename Real>
bool FasCgIteration<Real>::isQuiet(double rough_before) const {
  return shape_.finest().squaredLocalMotion() <= rough_before &&
         forces_.isSettled(part_.loaded(), tuning::kQuietForceShare);
}

template <typename Real>
bool FasCgIteration<Real>::wentTooFar() const {
  return limits_.areExceeded([this](int node) { return shape_.levels().displacements().of(node); });
}

// What is left of a time step, whose way may be small beside the displacement, is rounding: in
// single precision further cycles are in vain.
template <typename Real>
bool FasCgIteration<Real>::isRounded(const SolveContext& solve) const {
  return solve.in_time &&
         estimator_.left().now <= tuning::kRoundedDigits * shape_.displacementRounding();
}

// What went beyond its limit is cut back: the rest of the solve would be in vain.
template <typename Real>
bool FasCgIteration<Real>::isHopeless(const SolveContext& solve) const {
  const int cycles = solve.cycles;
  if (cycles > 0 && (wentTooFar() || isRounded(solve))) return true;
  const bool whole = shape_.levels().isWhole();
  if (!whole && progress_.isStuck(cycles, tuning::kPatienceInPart)) return true;
  const int most = solve.in_contact ? options_.max_cycles_in_contact : options_.max_cycles;
  const int patience = solve.in_contact ? options_.patience_in_contact : options_.patience;
  return cycles >= std::min(most, solve.budget.mostCycles()) || progress_.isStuck(cycles, patience);
}

template <typename Real>
void FasCgIteration<Real>::makeCycle(const SolveContext& solve) {
  if (estimator_.left().isWithin(tuning::kBlownUp)) {
    cycle_.run(solve, estimator_.left());
  } else {
    cycle_.smoothFrom(progress_.bestPlaces());
    cycle_.startHere();
  }
}

// Makes the smooth motion that was found, so that what is found is not thrown away. After a step of
// conjugate gradients that may leave more force unbalanced than there was: then a whole cycle is
// made from there instead.
template <typename Real>
void FasCgIteration<Real>::finish(const SolveContext& solve) {
  estimator_.noteCorrection();
  const bool may_worsen = cycle_.isConjugate();
  if (may_worsen) cycle_.startHere();
  const double before = shape_.greatestForce();
  shape_.correctAndSmooth(1.0, 1);
  if (may_worsen && shape_.greatestForce() > before) {
    shape_.restore(cycle_.start());
    makeCycle(solve);
  }
  settleForces(solve);
}

// When time has run out. The last cycle may have left what is rough unbalanced; springs in contact,
// the stiffest of all, would report forces that no tissue bears. So the smoother runs once more; a
// shape that went astray (tuning::kAstray) is replaced by the best one.
template <typename Real>
void FasCgIteration<Real>::finishLate(const SolveContext& solve) {
  GridLevel<Real>& finest = shape_.finest();
  finest.constrained.soon_touches = tuning::kSoonTouches;
  if (estimator_.left().isWithin(tuning::kAstray)) {
    finest.findForces();
    finest.smoothAndFindForces(cycle_.smootherSteps());
    settleForces(solve);
  } else {
    cycle_.smoothFrom(progress_.bestPlaces());
    estimator_.noteError(progress_.bestError());
  }
  finest.constrained.soon_touches = 0.0;
}

template <typename Real>
void FasCgIteration<Real>::settleForces(const SolveContext& solve) {
  for (int round = 0; round < tuning::kMostSettling; ++round) {
    if (solve.budget.isOverdrawn() || forces_.isSettled(part_.loaded(), tuning::kForceShare))
      return;
    shape_.finest().smoothAndFindForces(cycle_.smootherSteps(solve));
  }
}

template class FasCgIteration<float>;
template class FasCgIteration<double>;

}  // namespace robot_tissue
