#include "solvers/multigrid/cycle/error_estimator.h"

#include <algorithm>
#include <cmath>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

}  // namespace

void ErrorFactor::learn(double shown, Solve solve) {
  const bool is_long = solve == Solve::kLong;
  const double most = is_long ? tuning::kMostFactor : tuning::kMostSoon;
  const double kept = is_long ? value_ : tuning::kRemembered * value_;
  value_ = std::max(std::min(std::max(shown, least_), most), kept);
}

template <typename Real>
void ErrorEstimator<Real>::begin() {
  shape_.keepPlaces(start_);
  left_.at_start = 0.0;
  at_start_ = true;
}

template <typename Real>
void ErrorEstimator<Real>::update(const SolveContext& solve, const FasCgCycle<Real>& last) {
  left_.before = left_.now;
  left_.now = shape_.correctionNorm();
  const double trend_before = trend_;
  trend_ = last.isConjugate() ? std::max(left_.now, tuning::kDip * trend_) : left_.now;
  if (solve.cycles > 0 && knows_way_) learn(solve, last, trend_before);
  knows_way_ = true;
  const double least = tuning::kStill * std::sqrt(solve.hold.freeNodes() + 1.0);
  const double length = free_motion_ == nullptr
                            ? shape_.displacementNorm()
                            : std::max(shape_.distanceFrom(*free_motion_), least_way_);
  const double unit = std::max(length, least);
  error_ = factor.value() * trend_ / unit;
  const double gain =
      solve.cycles > 0 ? factor.value() * std::min(trend_ / trend_before, 1.0) : 0.0;
  error_after_ = std::max({factor.value() - 1.0, gain, tuning::kLeastAfter}) * trend_ / unit;
  if (!at_start_) return;
  left_.at_start = left_.now;
  mark_left_ = 0.0;
  at_start_ = false;
}

// Where cycles went by d and took |x| from a to b, what was really left is taken to fall with |x|:
// before, it was F a, after, F b, and the difference is what they went:
//
//   F = d / (a - b)
//
// over the last cycle, the whole solve, and, of long ones, their latest half.
template <typename Real>
void ErrorEstimator<Real>::learn(const SolveContext& solve, const FasCgCycle<Real>& last,
                                 double trend_before) {
  const double most_left = solve.in_contact ? tuning::kMostLeftInContact : tuning::kMostLeft;
  const auto fell = [&](double from) { return trend_ < most_left * from; };
  const int cycles = solve.cycles;
  double shown = 0.0;
  if (fell(trend_before)) shown = shape_.distanceFrom(last.start()) / (trend_before - trend_);
  if (cycles > 1 && fell(left_.at_start)) {
    shown = std::max(shown, distanceFromStart() / (left_.at_start - trend_));
  }
  if (!solve.in_contact && cycles >= mark_cycle_ + tuning::kShortest && fell(mark_left_)) {
    shown = std::max(shown, shape_.distanceFrom(mark_) / (mark_left_ - trend_));
  }
  if (isPowerOfTwo(cycles) && cycles >= tuning::kFirstMark) mark(cycles);
  if (shown == 0.0) return;
  const bool is_long = !solve.in_contact && cycles > tuning::kLong;
  factor.learn(shown, is_long ? ErrorFactor::Solve::kLong : ErrorFactor::Solve::kShort);
}

template <typename Real>
void ErrorEstimator<Real>::mark(int cycles) {
  shape_.keepPlaces(mark_);
  mark_left_ = trend_;
  mark_cycle_ = cycles;
}

template class ErrorEstimator<float>;
template class ErrorEstimator<double>;

}  // namespace robot_tissue
