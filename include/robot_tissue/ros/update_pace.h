// When a pose may be solved for: as soon as it came, `rate` times a second in the mean. Poses of
// about that rate are all taken where each is late by no more than about a period: one may come a
// period early.
#pragma once

#include <algorithm>

namespace robot_tissue {

class UpdatePace {
 public:
  explicit UpdatePace(double rate_hz) : period_s_(1.0 / rate_hz) {}

  // Now in seconds of any clock; one that was set back starts anew.
  bool isDue(double now_s) const { return now_s < last_s_ || now_s >= next_s_ - period_s_; }
  void take(double now_s) {
    if (now_s < last_s_) next_s_ = now_s;
    next_s_ = std::max(next_s_, now_s - period_s_) + period_s_;
    last_s_ = now_s;
  }

 private:
  double period_s_;
  double next_s_ = 0.0;
  double last_s_ = 0.0;
};

}  // namespace robot_tissue
