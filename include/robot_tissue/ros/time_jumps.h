// Whether time is another one: it went back, as where a bag plays again or a simulation is reset.
// The wall's clock is set back by a little now and then, as by NTP: that is the same time, in which
// no newer pose comes for as long.
#pragma once

#include <ros/time.h>

namespace robot_tissue {

class TimeJumps {
 public:
  // s, of the wall's clock. More: a pose is held for longer; less: tools are taken away for less.
  // Chosen, the default of ~tf_timeout: a silence as long is no fault either.
  static constexpr double kSetBack = 0.5;

  // At every look at the clock. True: it went back since the last one.
  bool wentBack(const ros::Time& now, bool is_simulated) {
    const double back = latest_.toSec() - now.toSec();
    const bool went_back = now < latest_ && (is_simulated || back > kSetBack);
    if (went_back || now > latest_) latest_ = now;
    return went_back;
  }

 private:
  ros::Time latest_;  // since it last went back
};

}  // namespace robot_tissue
