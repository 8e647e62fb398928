// How many iterations a load step may make, so that an update is bounded alike on every machine.
#pragma once

#include <algorithm>
#include <limits>

namespace robot_tissue {

// The longer a load step takes, the less it is content with: a shape in balance is shown before its
// contacts are settled, and they are settled in the load steps that follow. Once it is spent, no
// further solve begins: what the load step came to is gone on with later.
class LoadStepBound {
 public:
  // While one lives, what is solved is a load step of so many iterations at most; 0: of any number.
  class Scope {
   public:
    Scope(LoadStepBound& bound, int most) : bound_(bound) { bound.begin(most); }
    ~Scope() { bound_.begin(0); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    LoadStepBound& bound_;
  };

  void note(int iterations) {
    if (most_ > 0) made_ += std::min(iterations, std::numeric_limits<int>::max() - made_);
  }
  int left() const;  // for the next solve, which makes one at least
  bool isSpent() const { return most_ > 0 && made_ >= most_; }
  // Spacings (1): how deep tools may stand in a shape in balance whose contacts are not settled;
  // 0: they are to be settled.
  double bearableDepth() const;

 private:
  void begin(int most);

  int most_ = 0;
  int made_ = 0;
};

}  // namespace robot_tissue
