#include "solvers/multigrid/cycle/solve_progress.h"

#include <limits>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

template <typename Real>
void SolveProgress<Real>::begin() {
  least_left_ = std::numeric_limits<double>::infinity();
  has_best_ = false;
  farthest_ = 0.0;
}

// The first shape is the best one so far, whatever is left there, as that may be no number. A gain
// is a smaller |x|, or a shape farther from the start: on a long way |x| may grow before it falls.
// Not so in contact: what goes far there slips, and a smaller load step follows it better.
template <typename Real>
void SolveProgress<Real>::note(const SolveContext& solve, const ErrorEstimator<Real>& estimator,
                               const CompositeShape<Real>& shape) {
  if (!has_best_ || estimator.left().now < least_left_) {
    has_best_ = true;
    if (estimator.left().now < least_left_) least_left_ = estimator.left().now;
    shape.keepPlaces(best_);
    best_error_ = estimator.error();
    last_gain_ = solve.cycles;
  }
  if (solve.in_contact) return;
  const double gone = estimator.distanceFromStart();
  if (gone > cycle_tuning::kFarther * farthest_) {
    farthest_ = gone;
    last_gain_ = solve.cycles;
  }
}

template class SolveProgress<float>;
template class SolveProgress<double>;

}  // namespace robot_tissue
