#include "solvers/multigrid/cycle/line_search.h"

#include <algorithm>

namespace robot_tissue {

bool SlopeBracket::isFlat(double slope) const {
  return std::abs(slope) <= cycle_tuning::kFlatEnough * slope_;
}

void SlopeBracket::add(double length, double slope) {
  if (slope > 0.0 && std::isfinite(slope)) {
    low_ = length;
    low_slope_ = slope;
  } else {
    high_ = length;
    high_slope_ = slope;
    closed_ = true;
  }
}

double SlopeBracket::next(double length) const { return closed_ ? between() : secant(length); }

// Where a line through the slopes at 0 and at the length is zero, between 1.1 and 4 times the
// length.
double SlopeBracket::secant(double length) const {
  const double zero = low_slope_ < slope_ ? length * slope_ / (slope_ - low_slope_) : 2.0 * length;
  return std::min(std::max(zero, 1.1 * length), 4.0 * length);
}

// Where a line through the slopes at both ends of the bracket is zero, but a tenth of the bracket
// from either end at least; in the middle where the slope at the high end is not finite.
double SlopeBracket::between() const {
  if (!std::isfinite(high_slope_)) return 0.5 * (low_ + high_);
  const double zero = low_slope_ / (low_slope_ - high_slope_);
  return low_ + std::min(std::max(zero, 0.1), 0.9) * (high_ - low_);
}

}  // namespace robot_tissue
