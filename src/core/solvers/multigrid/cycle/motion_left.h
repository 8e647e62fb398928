// The length |x| of the motion that is left (CompositeShape::correctionNorm), in spacings.
#pragma once

namespace robot_tissue {

struct MotionLeft {
  double now = 0.0;
  double before = 0.0;    // the last cycle
  double at_start = 0.0;  // of the cycles

  // All three are false where `now` is NaN.
  bool isWithin(double times) const { return now <= times * at_start; }
  bool isAbove(double share) const { return now > share * before; }
  bool isAtMost(double share) const { return now <= share * before; }
};

}  // namespace robot_tissue
