// The time from one stamp to another. They may be farther apart than ros::Duration tells (2^31 s),
// which throws there, as where a clock starts at zero and leaps to the wall's.
#pragma once

#include <ros/time.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

// s; below zero where `to` is earlier. The number is that of ros::Duration::toSec().
inline double secondsBetween(const ros::Time& from, const ros::Time& to) {
  std::int64_t seconds = static_cast<std::int64_t>(to.sec) - static_cast<std::int64_t>(from.sec);
  std::int64_t nanoseconds =
      static_cast<std::int64_t>(to.nsec) - static_cast<std::int64_t>(from.nsec);
  if (nanoseconds < 0) {
    --seconds;
    nanoseconds += 1000000000;
  }
  return static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
}

// In whole milliseconds, rounded up, so that what is beyond a bound is told so; less than half of a
// nanosecond, of which stamps are made, is rounding.
inline std::string secondsText(double seconds) {
  return numberText(std::ceil(1e3 * seconds - 5e-7) / 1e3);
}

}  // namespace robot_tissue
