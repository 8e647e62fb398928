#include "solvers/multigrid/cycle/fas_cg_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "lattice/changed_cells.h"
#include "solvers/multigrid/cycle/patch_answers.h"
#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

}  // namespace

template <typename Real>
FasCgSolver<Real>::FasCgSolver(const Lattice& lattice, const ElasticModel& model,
                               const LayeredOptions& options)
    : lattice_(lattice),
      model_(model),
      tolerance_(options.tolerance),
      part_(lattice, options.tolerance),
      ends_(lattice, options.tolerance),
      forces_(shape_, options.tolerance),
      warm_start_(shape_),
      iteration_({shape_, part_, limits_, forces_}, options) {
  if (options.threads > 1) workers_ = std::make_unique<Workers>(options.threads);
}

template <typename Real>
void FasCgSolver<Real>::forget() {
  iteration_.forget();
  begins_anew_ = true;
  is_measure_due_ = false;
  part_.forget();
  warm_start_.forget();
  forces_.noteHeld(0.0);
  if (shape_.exists()) shape_.levels().forgetMembranes();
  knows_cells_ = false;
  if (shape_.exists() && shape_.levels().grid().hasEnds()) cells_.reset();
  ends_.forget();
}

template <typename Real>
const GridBox* FasCgSolver<Real>::visited() const {
  return !shape_.exists() || shape_.levels().isWhole() ? nullptr : &shape_.levels().grid().free();
}

template <typename Real>
Vec3 FasCgSolver<Real>::forceLeft() {
  return shape_.exists() ? forceLeftOn(shape_, lattice_.spacing()) : Vec3(Vec3::Zero());
}

// Of a long block the levels hang on where the loads are.
template <typename Real>
void FasCgSolver<Real>::expect(const LatticeState& state) {
  if (!ends_.mayBeLeftOut()) findLevels(state, Budget(0.0, 0));
}

// Measuring takes longer than a solve may: where there is no time for it, it is left to a later
// one.
template <typename Real>
void FasCgSolver<Real>::findLevels(const LatticeState& state, const Budget& budget) {
  // As where it starts: the levels are measured with these very cells.
  const bool is_measured = cells_ == measured_ && measured_ == state.cells;
  if (std::exchange(begins_anew_, false) && !is_measured) forgetLevels();
  const bool are_others = cells_ != state.cells;
  if (are_others) {
    is_measure_due_ =
        !cells_ || !measured_ || part_.isEmpty() ||
        changedCells(lattice_, *measured_, *state.cells).share > tuning::kMeasuredAgain;
  }
  const double known_factor = ends_.between().isEmpty() ? 1.0 : iteration_.errorFactor();
  const bool is_longer = ends_.renew(part_.seeds(), state.cells);
  is_measure_due_ = is_measure_due_ || is_longer;
  if (!are_others && !is_longer && (!is_measure_due_ || part_.isEmpty())) return;
  knows_cells_ = false;
  const bool can_wait = cells_ && !part_.isEmpty() && !is_longer;
  const double before_ms = budget.elapsedMs();
  if (is_measure_due_ && (!can_wait || budget.leftMs() >= measuring_ms_)) {
    measureLevels(state, is_longer ? known_factor : 1.0, is_longer);
    measuring_ms_ = budget.elapsedMs() - before_ms;
  } else if (are_others) {
    const std::vector<double> stiffness = shape_.levels().grid().greatestStiffness();
    KnownLevels known = {shape_.levels().takeSources(), stiffness,
                         changedCells(lattice_, *cells_, *state.cells).box, part_.box(),
                         part_.layers()};
    shape_.reset(std::make_unique<GridHierarchy<Real>>(lattice_, model_, *state.cells,
                                                       workers_.get(), std::move(known)));
    iteration_.reset();
    measuring_ms_ = tuning::kMeasuringOverLevels * (budget.elapsedMs() - before_ms);
  }
  cells_ = state.cells;
  warm_start_.forget();
}

template <typename Real>
void FasCgSolver<Real>::measureLevels(const LatticeState& state, double known_factor,
                                      bool is_longer) {
  KnownLevels known;
  known.between = ends_.between();
  if (shape_.exists() && !is_longer) known.sources = shape_.levels().takeSources();
  shape_.reset(std::make_unique<GridHierarchy<Real>>(lattice_, model_, *state.cells, workers_.get(),
                                                     std::move(known)));
  iteration_.resetOnTrial(lattice_, model_, state, known_factor);
  measured_ = state.cells;
  is_measure_due_ = false;
}

template <typename Real>
SolveReport FasCgSolver<Real>::run(ConstrainedState& shape, const DofConstraints& hold,
                                   const std::vector<int>& disturbed, const Budget& budget) {
  SolveContext solve{shape, hold, budget};
  solve.in_contact = isInContact(shape);
  solve.in_time = model_.inertia() != nullptr;
  solve.has_changed = solve.in_contact || !disturbed.empty() || solve.in_time;
  if (cells_ != shape.state.cells) part_.forgetLoads();
  part_.findSeeds(solve, disturbed);
  if (solve.in_time) part_.seedAll();
  findLevels(shape.state, budget);
  SolveReport report;
  wants_double_ = false;
  if (part_.isEmpty()) return report;
  double turned = std::numeric_limits<double>::infinity();  // a patch, in the last round (rad)
  for (int round = 0; turned > tuning::kTurned && round < tuning::kMostTurns; ++round) {
    report.status = balance(solve);
    wants_double_ = isForDouble(solve, report.status);
    if (wants_double_) return giveUp(solve);
    if (!shape_.levels().isFinite()) {
      report = giveUp(solve);
      forgetLevels();
      return report;
    }
    writeShape(solve);
    turned = settlePatches(solve);
    if (report.status != SolveStatus::kOk) break;
  }
  const bool turns_on = turned > std::max(tuning::kTurned, tuning::kTurnsOn * tolerance_);
  if (turns_on && report.status == SolveStatus::kOk) report.status = SolveStatus::kUnconverged;
  warm_start_.noteEnd(report.status);
  const double error = iteration_.error();
  report.error_estimate = std::isfinite(error) ? std::hypot(error, part_.missed()) : 1.0;
  answer(solve, report);
  return report;
}

// Where tissue is about to buckle, a motion has hardly any stiffness: forces are balanced up to
// rounding, and that, over the stiffness, is more than the tolerance; so is it in short time steps
// of viscous tissue, whose ways are small beside their displacements. In contact a solve ends
// unconverged for other reasons, too, and its load step is tried in shorter ones; so does one that
// had few cycles, of which there would be no more in double.
template <typename Real>
bool FasCgSolver<Real>::isForDouble(const SolveContext& solve, SolveStatus status) const {
  return std::is_same_v<Real, float> && status == SolveStatus::kUnconverged &&
         (!solve.in_contact || solve.in_time) &&
         (solve.cycles < solve.budget.mostCycles() || solve.cycles > 2 * tuning::kUsualCycles) &&
         forces_.residual(solve.shape) <= tuning::kRoundedForces;
}

// They are made anew for the next solve: what is not finite stays where nothing sets it anew.
template <typename Real>
void FasCgSolver<Real>::forgetLevels() {
  cells_.reset();
  measured_.reset();
}

// As it was when the solve began.
template <typename Real>
SolveReport FasCgSolver<Real>::giveUp(const SolveContext& solve) {
  prepare(solve);
  warm_start_.forget();
  SolveReport report;
  report.status = SolveStatus::kUnconverged;
  report.error_estimate = 1.0;
  answer(solve, report);
  return report;
}

// In the part around the seeds, in a larger one where it is not smooth beyond that, or in all of it
// where it does not go well.
template <typename Real>
SolveStatus FasCgSolver<Real>::balance(SolveContext& solve) {
  open(solve, part_.box());
  for (int round = 1;; ++round) {
    solve.warm_started = warm_start_.take() && forces_.greatestAtStart() > 0.0 && warm_start_.go();
    const SolveStatus status = iteration_.run(solve);
    const bool fails = status == SolveStatus::kUnconverged && !iteration_.wentTooFar();
    if (fails && !shape_.levels().isWhole()) {
      open(solve, shape_.levels().grid().between());
    } else if (status == SolveStatus::kOk && part_.raise(shape_.missedBeyond())) {
      writeShape(solve);
      open(solve, part_.box());
    } else if (status != SolveStatus::kOk || iteration_.error() <= part_.allowedError() ||
               round > tuning::kMostRounds) {
      return status;
    }
  }
}

template <typename Real>
void FasCgSolver<Real>::open(const SolveContext& solve, const GridBox& box) {
  if (shape_.levels().open(box, part_.layers(), solve.shape.state.displacement)) {
    warm_start_.forget();
    iteration_.noteOpened();
    knows_cells_ = false;
  }
  prepare(solve);
}

// Where the shape is the one that the last solve left, and held alike, its cells' forces are known.
template <typename Real>
void FasCgSolver<Real>::prepare(const SolveContext& solve) {
  const std::vector<Vec3>& displacement = solve.shape.state.displacement;
  takeTimeStep(solve);
  const Holds holds = shape_.levels().constraints().bind(solve.shape, solve.hold);
  const bool moved = shape_.levels().displacements().take(displacement, solve.hold.dirichletMask());
  shape_.levels().renewMembranes();
  limits_.begin(displacement);
  warm_start_.noteStart();
  if (knows_cells_ && holds == Holds::kAsBefore && !moved) {
    shape_.finest().findForcesOfConstrained();
  } else {
    shape_.finest().findForces();
  }
  knows_cells_ = model_.inertia() == nullptr && !model_.hasMembranes();
  forces_.begin();
}

template <typename Real>
void FasCgSolver<Real>::takeTimeStep(const SolveContext& solve) {
  const InertialTerm* inertia = model_.inertia();
  shape_.levels().takeTimeStep(inertia);
  knows_cells_ = knows_cells_ && inertia == nullptr;
  if (inertia == nullptr) return iteration_.measureFrom(nullptr, 0.0);
  iteration_.measureFrom(&free_motion_, inertia->least_way / lattice_.spacing());
  shape_.levels().displacements().take(inertia->free_motion, solve.hold.dirichletMask());
  shape_.keepPlaces(free_motion_);
}

template <typename Real>
void FasCgSolver<Real>::writeShape(SolveContext& solve) const {
  shape_.levels().displacements().writeTo(solve.shape.state.displacement,
                                          solve.hold.dirichletMask());
}

// Patches by force go where the levels moved them, as rigid bodies do. How far one turned (rad): by
// so much its nodes are no longer where they were found to balance.
template <typename Real>
double FasCgSolver<Real>::settlePatches(SolveContext& solve) {
  const std::optional<double> turned =
      movePatches(lattice_, shape_.finest().constrained.motion, solve.shape);
  if (!turned) return 0.0;
  shape_.levels().constraints().renewGroups(solve.shape, solve.hold);
  shape_.finest().findForces();
  return *turned;
}

template <typename Real>
void FasCgSolver<Real>::answer(const SolveContext& solve, SolveReport& report) {
  const CompositeGrid<Real>& grid = shape_.levels().grid();
  const double unit = grid.modulus() * lattice_.spacing() * lattice_.spacing();
  PatchAnswers answers = answersOf(lattice_, solve, [&grid, unit](int node) -> Vec3 {
    return unit * grid.finest().wholeForce(grid.entryOf(node));
  });
  forces_.noteHeld(answers.greatest / unit);
  report.patches = std::move(answers.all);
  report.iterations = solve.cycles;
  report.residual = forces_.residual(solve.shape);
  report.active_nodes = part_.nodesIn(grid.free(), solve.hold);
  report.layers = part_.layersIn(grid.free());
}

Precision precisionFor(const ElasticModel& model, const LayeredOptions& options) {
  const bool suffices = options.tolerance >= tuning::kSinglePrecision && !model.movesInTime() &&
                        !model.hasMembranes();
  return suffices ? Precision::kSingle : Precision::kDouble;
}

std::unique_ptr<MultigridSolver> makeMultigridSolver(const Lattice& lattice,
                                                     const ElasticModel& model,
                                                     const LayeredOptions& options,
                                                     Precision precision) {
  if (precision == Precision::kSingle) {
    return std::make_unique<FasCgSolver<float>>(lattice, model, options);
  }
  return std::make_unique<FasCgSolver<double>>(lattice, model, options);
}

template class FasCgSolver<float>;
template class FasCgSolver<double>;

}  // namespace robot_tissue
