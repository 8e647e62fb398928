// What the cycles of a solve have gained: the best shape so far, and when something was gained
// last.
#pragma once

#include "solvers/multigrid/cycle/error_estimator.h"

namespace robot_tissue {

template <typename Real>
class SolveProgress {
 public:
  // Cycles begin.
  void begin();
  // After each cycle, and before the first.
  void note(const SolveContext& solve, const ErrorEstimator<Real>& estimator,
            const CompositeShape<Real>& shape);

  // In so many cycles there was no gain.
  bool isStuck(int cycles, int patience) const { return cycles > last_gain_ + patience; }
  const CompositeVector<Real>& bestPlaces() const { return best_; }
  double bestError() const { return best_error_; }

 private:
  CompositeVector<Real> best_;
  bool has_best_ = false;  // of these cycles
  double best_error_ = 1.0;
  double least_left_ = 0.0;  // |x|, there
  double farthest_ = 0.0;    // from where the cycles began, in spacings
  int last_gain_ = 0;        // cycle that led to less left, or farther
};

extern template class SolveProgress<float>;
extern template class SolveProgress<double>;

}  // namespace robot_tissue
