#include "solvers/multigrid/cycle/layered_method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

LayeredMethod::LayeredMethod(const Lattice& lattice, const ElasticModel& model,
                             const LayeredOptions& options)
    : lattice_(lattice),
      model_(model),
      options_(options),
      hold_(lattice, model),
      precision_(precisionFor(model, options)),
      solver_(makeMultigridSolver(lattice, model, options, precision_)) {}

void LayeredMethod::use(Precision precision) {
  if (precision_ == precision) return;
  precision_ = precision;
  std::swap(solver_, other_);
  if (!solver_) solver_ = makeMultigridSolver(lattice_, model_, options_, precision);
}

void LayeredMethod::forget() {
  use(precisionFor(model_, options_));
  solver_->forget();
  other_.reset();
}

// Beside contacts a time step may be solved in single precision: of what is off then nothing is
// carried on but a velocity, which viscosity takes.
Precision LayeredMethod::precisionIn(const LatticeState& state) const {
  const InertialTerm* step = model_.inertia();
  const bool may = step != nullptr && step->beside_contacts && !model_.hasMembranes() &&
                   options_.tolerance >= cycle_tuning::kSinglePrecision;
  if (!may) return precisionFor(model_, options_);
  double farthest = 0.0;
  for (const Vec3& moved : state.displacement) farthest = std::max(farthest, moved.squaredNorm());
  const double allowed = options_.tolerance * step->least_way /
                         std::sqrt(static_cast<double>(state.displacement.size()));
  const double rounding = std::numeric_limits<float>::epsilon() / 2.0F * std::sqrt(farthest);
  return rounding <= cycle_tuning::kRoundingInTime * allowed ? Precision::kSingle
                                                             : Precision::kDouble;
}

void LayeredMethod::beginStep(const LatticeState& state) {
  if (model_.movesInTime()) use(precisionIn(state));
  solver_->beginStep();
}

double LayeredMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

int LayeredMethod::usualIterations() const { return cycle_tuning::kUsualCycles; }

SolveReport LayeredMethod::solve(std::vector<LoadingPatch>& patches,
                                 const std::vector<int>& disturbed, LatticeState& state) {
  const Budget budget(options_.max_ms, most_cycles_);
  ConstrainedState shape{std::move(state), std::move(patches)};
  hold_.bind(shape);
  hold_.place(shape);
  solver_->limitWays(limits_);
  SolveReport report = solver_->run(shape, hold_, disturbed, budget);
  if (solver_->wantsDouble()) {
    const int in_single = report.iterations;
    use(Precision::kDouble);
    if (!model_.movesInTime()) other_.reset();
    hold_.bind(shape);
    solver_->limitWays(limits_);  // those that it had are of an earlier surface
    report = solver_->run(shape, hold_, disturbed, budget);
    report.iterations += in_single;
  }
  state = std::move(shape.state);
  patches = std::move(shape.patches);
  report.wall_ms = budget.elapsedMs();
  return report;
}

}  // namespace robot_tissue
