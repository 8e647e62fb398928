#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "robot_tissue/core/tissue.h"
#include "tissue/tuning.h"

namespace robot_tissue {

// Whether the rounds of a load step (a solve, then a look at the contacts) still lead somewhere: a
// lower error than before, or tissue that went farther than before, as where it slips.
class RoundGain {
 public:
  explicit RoundGain(Tissue::Displacements start) : start_(std::move(start)) {}

  void note(const SolveReport& report, const std::vector<Vec3>& now, bool whole) {
    double way = 0.0;
    for (std::size_t node = 0; node < now.size(); ++node) {
      way += (now[node] - (*start_)[node]).squaredNorm();
    }
    const bool gains = whole || report.error_estimate < tuning::kNearer * least_ ||
                       way > tuning::kFarther * tuning::kFarther * farthest_;
    idle_ = gains ? 0 : idle_ + std::max(report.iterations, tuning::kIdleRound);
    least_ = std::min(least_, report.error_estimate);
    farthest_ = std::max(farthest_, way);
  }
  bool isOver() const { return idle_ > tuning::kMostIdle; }

 private:
  Tissue::Displacements start_;
  double least_ = std::numeric_limits<double>::infinity();
  double farthest_ = 0.0;  // squared (m^2)
  int idle_ = 0;
};

}  // namespace robot_tissue
