// A time of the wall's clock after which nothing more is begun.
#pragma once

#include <chrono>
#include <limits>

namespace robot_tissue {

class Deadline {
 public:
  // From now on (s); infinite: none.
  explicit Deadline(double seconds = std::numeric_limits<double>::infinity()) : seconds_(seconds) {}

  double leftMs() const {  // < 0: it is over
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    return 1e3 * (seconds_ - elapsed.count());
  }
  double wholeMs() const { return 1e3 * seconds_; }
  bool isOver() const { return leftMs() < 0.0; }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace robot_tissue
