// Numbers that look random and are the same each time (a linear congruential generator: Numerical
// Recipes).
#pragma once

#include <cstdint>

namespace robot_tissue {

class SteadyNumbers {
 public:
  std::uint32_t next() { return number_ = 1664525U * number_ + 1013904223U; }
  // Of -1/2 to 1/2, exact also in single precision.
  template <typename Real = double>
  Real nextReal() {
    return Real(next() >> 8) / Real(1 << 24) - Real(0.5);
  }

 private:
  std::uint32_t number_ = 1;
};

}  // namespace robot_tissue
