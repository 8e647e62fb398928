#include "solvers/multigrid/cycle/layered_method.h"

#include <cmath>
#include <utility>

namespace robot_tissue {

LayeredMethod::LayeredMethod(const Lattice& lattice, const ElasticModel& model,
                             const LayeredOptions& options)
    : lattice_(lattice),
      options_(options),
      hold_(lattice, model),
      solver_(makeMultigridSolver(lattice, model, options)) {}

double LayeredMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

void LayeredMethod::limitWays(std::vector<double> longest) {
  std::vector<MultigridSolver::NodeLimit> limits;
  for (std::size_t node = 0; node < longest.size(); ++node) {
    if (std::isfinite(longest[node])) limits.push_back({static_cast<int>(node), longest[node]});
  }
  solver_->limitWays(std::move(limits));
}

SolveReport LayeredMethod::solve(std::vector<LoadingPatch>& patches,
                                 const std::vector<int>& disturbed, LatticeState& state) {
  const Budget budget(options_.max_ms);
  ConstrainedState shape{std::move(state), std::move(patches)};
  hold_.bind(shape);
  hold_.place(shape);
  SolveReport report = solver_->run(shape, hold_, disturbed, budget);
  state = std::move(shape.state);
  patches = std::move(shape.patches);
  report.wall_ms = budget.elapsedMs();
  return report;
}

}  // namespace robot_tissue
