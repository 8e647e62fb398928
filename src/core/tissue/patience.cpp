#include "robot_tissue/core/patience.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

constexpr int kNoBound = std::numeric_limits<int>::max();

}  // namespace

int Patience::most() const {
  return is_for_scene_ ? timesUsual(tuning::kMostSpent) : tuning::kMostSpentOnAWay;
}

int Patience::mostOfLoadStep() const { return timesUsual(tuning::kMostOfLoadStep); }

// All there are of a method that does not know them.
int Patience::timesUsual(double times) const {
  return usual_ == kNoBound ? kNoBound : static_cast<int>(std::lround(times * usual_));
}

void Patience::note(int iterations, bool converged, Of what) {
  const int times = what == Of::kTimeStep ? tuning::kTimesInTimeStep : 1;
  const int counted = (iterations + times - 1) / times;
  taken_ += counted;
  unsettled_ += counted;
  converged_ = converged;
}

int Patience::left(Of what) const {
  if (!is_for_scene_ || usual_ == kNoBound) return kNoBound;
  const int left = std::max(0, usual_ + most() - spent_ - taken_);
  return what == Of::kTimeStep ? tuning::kTimesInTimeStep * left : left;
}

void Patience::endSolve() {
  if (!is_for_scene_ && !converged_) spent_ = std::min(spent_ + unsettled_, most());
  unsettled_ = 0;
}

void Patience::endLoadStep() {
  if (is_for_scene_ && taken_ > usual_) {
    spent_ = std::min(spent_ + taken_ - usual_, most());
  } else if (converged_) {
    spent_ = std::max(spent_ - timesUsual(tuning::kForgiven), 0);
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
