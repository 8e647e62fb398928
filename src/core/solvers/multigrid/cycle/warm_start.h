// The first guess of a load step: the shape goes on, or back, the way that it went in the step
// before.
#pragma once

#include "robot_tissue/core/solve_report.h"
#include "solvers/multigrid/cycle/composite_shape.h"

namespace robot_tissue {

template <typename Real>
class WarmStart {
 public:
  explicit WarmStart(CompositeShape<Real>& shape) : shape_(shape) {}

  void beginStep() { first_of_step_ = true; }
  // Drops the last step: it is of other nodes than those that are open now.
  void forget() { has_start_ = has_step_ = false; }
  // The next solve begins at the shape as it is. In the first solve of a step, the last step is
  // then last_step = this shape - the one at which the last step began.
  void noteStart();
  // Whether the last solve was cut short.
  void noteEnd(SolveStatus status) { ended_late_ = status == SolveStatus::kLate; }

  // Once a step: whether it is due.
  bool take();
  // Goes as far as the forces work along it. False: it leads nowhere, nothing has moved.
  bool go();

 private:
  bool isGood(double squared_local_before, const CompositeVector<Real>& undo);

  CompositeShape<Real>& shape_;
  CompositeVector<Real> start_, last_step_;
  bool has_start_ = false, has_step_ = false, first_of_step_ = false;
  bool ended_late_ = false;
};

extern template class WarmStart<float>;
extern template class WarmStart<double>;

}  // namespace robot_tissue
