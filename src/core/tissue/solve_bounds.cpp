#include "tissue/solve_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/tuning.h"

namespace robot_tissue {

double SolveBounds::leftOfTimeStepMs() const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double of_solve = max_ms_ > 0.0 ? max_ms_ : kNone;
  const double left = deadline_ ? deadline_->leftMs() : kNone;
  return std::min(of_solve, left) + tuning::kMostBeyondMs;
}

bool SolveBounds::isTimeStepOver() const {
  return motion_.isInTimeStep() && leftOfTimeStepMs() <= 0.0;
}

double SolveBounds::mostMs() const {
  if (motion_.isInTimeStep()) {
    const double left = leftOfTimeStepMs();
    return std::isfinite(left) ? std::max(tuning::kLeastMs, left) : 0.0;
  }
  if (!deadline_) return max_ms_;
  const double left = deadline_->leftMs();
  if (!std::isfinite(left)) return max_ms_;
  const double solve = std::min(tuning::kShareOfTime * left, left - look_ms_);
  const double most = std::max(tuning::kLeastMs, solve);
  return max_ms_ > 0.0 ? std::min(max_ms_, most) : most;
}

int SolveBounds::mostIterations(double cost) const {
  const int left = patience_.left(solved(), cost);
  return std::max(1, motion_.isInTimeStep() ? left : std::min(left, patience_.bound().left()));
}

Patience::Of SolveBounds::solved() const {
  return motion_.isInTimeStep() ? Patience::Of::kTimeStep : Patience::Of::kLoadStep;
}

bool SolveBounds::wasHurried(double solve_ms) const {
  if (!isBounded()) return false;
  const double left = deadline_->leftMs() + solve_ms;  // when it began
  return max_ms_ <= 0.0 || max_ms_ >= tuning::kShareOfTime * left;
}

void SolveBounds::noteSolve(const SolveReport& solve) {
  const double ends = tuning::kIterationsOfEnds;
  shortest_ms_ = solve.wall_ms * (1.0 + ends) / (std::max(1, solve.iterations) + ends);
}

void SolveBounds::noteLook(double ms) { look_ms_ = std::max(ms, tuning::kLooksFade * look_ms_); }

bool SolveBounds::isRoundForNextCall() const {
  if (!isBounded()) return false;
  const double round = shortest_ms_ + look_ms_;
  return deadline_->leftMs() < round && round <= deadline_->wholeMs();
}

bool SolveBounds::isLookForNextCall() const {
  return isRoundForNextCall() && deadline_->leftMs() < look_ms_ - tuning::kMostOverstepMs;
}

}  // namespace robot_tissue
