// A time of the wall's clock after which nothing more is begun, or the end of the program.
#pragma once

#include <chrono>
#include <limits>

namespace robot_tissue {

class Deadline {
 public:
  // Asked at every look at the time; true: it is over long since. Of any thread.
  using IsStopped = bool (*)();

  // From now on (s); infinite: none.
  explicit Deadline(double seconds = std::numeric_limits<double>::infinity(),
                    IsStopped is_stopped = nullptr)
      : seconds_(seconds), is_stopped_(is_stopped) {}

  double leftMs() const {  // < 0: it is over
    if (is_stopped_ != nullptr && is_stopped_()) return kLongSinceMs;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    return 1e3 * (seconds_ - elapsed.count());
  }
  double wholeMs() const { return 1e3 * seconds_; }
  bool isOver() const { return leftMs() < 0.0; }

 private:
  // Finite, and beyond the time that a step that was begun has to come to its end.
  static constexpr double kLongSinceMs = -1e9;

  double seconds_;
  IsStopped is_stopped_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace robot_tissue
