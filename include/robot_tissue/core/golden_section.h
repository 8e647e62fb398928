// Where a function of one number is lowest (Kiefer 1953).
#pragma once

#include <cmath>

namespace robot_tissue {

// Of a function with one lowest place between the two, to (high - low) 0.618^sections.
template <typename Function>
double lowestBetween(double low, double high, int sections, const Function& value) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = value(left), at_right = value(right);
  for (int section = 0; section < sections; ++section) {
    if (at_left < at_right) {
      high = right;
      right = left, at_right = at_left;
      left = high - golden * (high - low);
      at_left = value(left);
    } else {
      low = left;
      left = right, at_left = at_right;
      right = low + golden * (high - low);
      at_right = value(right);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace robot_tissue
