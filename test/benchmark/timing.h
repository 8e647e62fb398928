// What the benchmarks that time updates share.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

namespace robot_tissue {

using Clock = std::chrono::steady_clock;

inline double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

inline double millisecondsOf(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Of the processor, so that other programs do not show: of all threads, and of this one alone.
inline double processorMs() { return millisecondsOf(CLOCK_PROCESS_CPUTIME_ID); }
inline double threadMs() { return millisecondsOf(CLOCK_THREAD_CPUTIME_ID); }

inline double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

}  // namespace robot_tissue
