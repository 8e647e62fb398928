// Sets of numbers that were found to belong together. The lowest number stands for its set, so that
// the outcome does not hang on the order in which they were joined.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class DisjointSets {
 public:
  // Numbers from 0 on, each in a set of its own.
  explicit DisjointSets(std::size_t count) : lower_(count) {
    std::iota(lower_.begin(), lower_.end(), 0);
  }

  // The lowest number of the set. Halves the way to it (Tarjan and van Leeuwen 1984).
  int lowest(int number) {
    while (lower_[at(number)] != number) {
      number = lower_[at(number)] = lower_[at(lower_[at(number)])];
    }
    return number;
  }

  void join(int a, int b) {
    const int lowest_a = lowest(a), lowest_b = lowest(b);
    lower_[at(std::max(lowest_a, lowest_b))] = std::min(lowest_a, lowest_b);
  }

 private:
  std::vector<int> lower_;  // of the same set, or itself
};

}  // namespace robot_tissue
