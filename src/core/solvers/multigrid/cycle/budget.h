// Time that a solve may take.
#pragma once

#include <chrono>

namespace robot_tissue {

// A clock that may run out.
class Budget {
 public:
  explicit Budget(double max_ms) : max_ms_(max_ms) {}
  double elapsedMs() const {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - started_;
    return elapsed.count();
  }
  bool isSpent() const { return max_ms_ > 0.0 && elapsedMs() > max_ms_; }

 private:
  double max_ms_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace robot_tissue
