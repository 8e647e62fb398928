#include "solvers/multigrid/cycle/layered_method.h"

#include <utility>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

LayeredMethod::LayeredMethod(const Lattice& lattice, const ElasticModel& model,
                             const LayeredOptions& options)
    : lattice_(lattice),
      model_(model),
      options_(options),
      hold_(lattice, model),
      precision_(precisionFor(model, options)) {
  makeSolver(precision_);
}

void LayeredMethod::makeSolver(Precision precision) {
  precision_ = precision;
  solver_ = makeMultigridSolver(lattice_, model_, options_, precision);
}

void LayeredMethod::forget() {
  const Precision usual = precisionFor(model_, options_);
  if (precision_ == usual) return solver_->forget();
  makeSolver(usual);
}

double LayeredMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

int LayeredMethod::usualIterations() const { return cycle_tuning::kUsualCycles; }

SolveReport LayeredMethod::solve(std::vector<LoadingPatch>& patches,
                                 const std::vector<int>& disturbed, LatticeState& state) {
  const Budget budget(options_.max_ms, most_cycles_);
  ConstrainedState shape{std::move(state), std::move(patches)};
  hold_.bind(shape);
  hold_.place(shape);
  SolveReport report = solver_->run(shape, hold_, disturbed, budget);
  if (solver_->wantsDouble()) {
    const int in_single = report.iterations;
    makeSolver(Precision::kDouble);
    hold_.bind(shape);
    report = solver_->run(shape, hold_, disturbed, budget);
    report.iterations += in_single;
  }
  state = std::move(shape.state);
  patches = std::move(shape.patches);
  report.wall_ms = budget.elapsedMs();
  return report;
}

}  // namespace robot_tissue
