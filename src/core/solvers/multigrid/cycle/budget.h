// Time and cycles that a solve may take.
#pragma once

#include <chrono>
#include <limits>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

// A clock that may run out, and a count that does.
class Budget {
 public:
  Budget(double max_ms, int most_cycles) : max_ms_(max_ms), most_cycles_(most_cycles) {}
  double elapsedMs() const {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - started_;
    return elapsed.count();
  }
  double leftMs() const {
    return max_ms_ > 0.0 ? max_ms_ - elapsedMs() : std::numeric_limits<double>::infinity();
  }
  int mostCycles() const { return most_cycles_; }
  // Whether time would be over before half of another piece of work of that length is done.
  bool isSpentFor(double piece_ms) const { return leftMs() < 0.5 * piece_ms; }
  bool isOverdrawn() const { return leftMs() < -cycle_tuning::kMostOverdrawn * max_ms_; }

 private:
  double max_ms_;
  int most_cycles_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace robot_tissue
