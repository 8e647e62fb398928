#include "robot_tissue/coupling/plane_drift.h"

#include "tuning.h"

namespace robot_tissue {

double PlaneDrift::foresee(double share) {
  met_ = 0.0;
  foreseen_ = usual_.value_or(0.0) * share;
  return foreseen_;
}

// Where two touches share a push, one drifts while the other does not, and the next time the other
// way round: so a part of what was not foreseen is learned.
void PlaneDrift::learn() {
  const double learned = usual_ ? tuning::kDriftLearned : 1.0;
  usual_ = foreseen_ + learned * met_;
  foreseen_ = met_ = 0.0;
}

void PlaneDrift::forget() {
  usual_.reset();
  foreseen_ = met_ = 0.0;
}

}  // namespace robot_tissue
