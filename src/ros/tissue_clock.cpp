#include "robot_tissue/ros/tissue_clock.h"

#include <algorithm>

#include "robot_tissue/ros/seconds_between.h"

namespace robot_tissue {

double TissueClock::advance(const ros::Time& stamp, bool moves, double reached) {
  const double gap = last_.isZero() ? 0.0 : secondsBetween(last_, stamp);
  last_ = stamp;
  left_out_ = 0.0;
  if (!(gap > 0.0)) return now_;
  if (gap <= longest_) usual_ = gap;
  const double due = std::max(0.0, now_ - reached);  // that the tissue is behind already
  const double passed = std::min(gap, moves ? std::max(0.0, longest_ - due) : usual_);
  if (moves) left_out_ = gap - passed;
  return now_ += passed;
}

}  // namespace robot_tissue
