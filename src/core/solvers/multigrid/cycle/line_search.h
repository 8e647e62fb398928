// The length along a direction at which the forces no longer work along it: a zero of the slope
// (their work along it), between a place where it is positive and one beyond where it is not.
#pragma once

#include <cmath>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

class SlopeBracket {
 public:
  // The slope at length 0, positive.
  explicit SlopeBracket(double slope) : slope_(slope), low_slope_(slope) {}

  bool isFlat(double slope) const;  // a line search may end there
  void add(double length, double slope);
  bool isClosed() const { return closed_; }
  double next(double length) const;  // where to look after that length
  bool gotOn() const { return low_ > 0.0; }

 private:
  double secant(double length) const;
  double between() const;

  double slope_;
  double low_ = 0.0, low_slope_;
  double high_ = 0.0, high_slope_ = 0.0;
  bool closed_ = false;  // there is a high one
};

// Having gone along the direction by 1, where the slope is `slope`: further or back. goTo(length)
// goes there and returns the slope. False: it leads nowhere.
template <typename GoTo>
bool searchLine(double slope_at_start, double slope, GoTo goTo) {
  SlopeBracket bracket(slope_at_start);
  double length = 1.0;
  for (int trial = 0; trial < cycle_tuning::kTrials; ++trial) {
    if (bracket.isFlat(slope)) return true;
    bracket.add(length, slope);
    if (!bracket.isClosed() && trial >= cycle_tuning::kTrialsAhead) return true;
    length = bracket.next(length);
    slope = goTo(length);
  }
  return bracket.gotOn() && std::isfinite(slope);
}

}  // namespace robot_tissue
