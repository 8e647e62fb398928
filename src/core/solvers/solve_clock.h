// How long a solve takes, by the wall's clock.
#pragma once

#include <chrono>

namespace robot_tissue {

class SolveClock {
 public:
  void start() { started_ = std::chrono::steady_clock::now(); }
  double elapsedMs() const {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - started_;
    return elapsed.count();
  }
  bool isOver(double max_ms) const { return max_ms > 0.0 && elapsedMs() > max_ms; }  // 0: no bound

 private:
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace robot_tissue
