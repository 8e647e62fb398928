#include "robot_tissue/core/patience.h"

#include <algorithm>
#include <limits>

#include "tissue/tuning.h"

namespace robot_tissue {

int Patience::most() const { return is_for_scene_ ? tuning::kMostSpent : tuning::kMostSpentOnAWay; }

void Patience::note(int iterations, bool converged) {
  taken_ += iterations;
  unsettled_ += iterations;
  converged_ = converged;
}

int Patience::left() const {
  constexpr int kNoBound = std::numeric_limits<int>::max();
  if (!is_for_scene_ || usual_ == kNoBound) return kNoBound;
  return std::max(0, usual_ + tuning::kMostAtOnce * (most() - spent_) - taken_);
}

void Patience::endSolve() {
  if (!is_for_scene_ && !converged_) spent_ = std::min(spent_ + unsettled_, most());
  unsettled_ = 0;
}

void Patience::endLoadStep() {
  if (is_for_scene_ && taken_ > usual_) {
    spent_ = std::min(spent_ + taken_ - usual_, most());
  } else if (converged_) {
    spent_ = std::max(spent_ - tuning::kForgiven, 0);
  }
  taken_ = 0;
  converged_ = true;
}

void Patience::beginTrial() {
  before_trial_ = spent_;
  spent_ = std::max(spent_, spent_by_trials_);
}

void Patience::endTrial() {
  spent_by_trials_ = spent_;
  spent_ = before_trial_;
}

}  // namespace robot_tissue
