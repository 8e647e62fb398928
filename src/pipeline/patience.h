// Whether it is worth going on with a way whose load steps take long.
#pragma once

#include <algorithm>

#include "tuning.h"

namespace robot_tissue {

// Counts the iterations of load steps beyond those that are usual, over all updates. A slip or two
// are forgiven by and by; tissue that is crushed between tools asks for hundreds in every other
// load step, for as long as the way goes on.
class Patience {
 public:
  void limit() { is_limited_ = true; }  // else it never ends
  void forget() { spent_ = 0; }
  // Of one load step.
  void note(int iterations, int usual) {
    spent_ = iterations > usual ? std::min(spent_ + iterations - usual, tuning::kMostSpent)
                                : std::max(spent_ - tuning::kForgiven, 0);
  }
  bool isOver() const { return is_limited_ && spent_ >= tuning::kMostSpent; }

 private:
  bool is_limited_ = false;
  int spent_ = 0;  // iterations
};

}  // namespace robot_tissue
