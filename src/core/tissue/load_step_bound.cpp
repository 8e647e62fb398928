#include "robot_tissue/core/load_step_bound.h"

#include <algorithm>
#include <limits>

#include "tissue/tuning.h"

namespace robot_tissue {

void LoadStepBound::begin(int most) {
  most_ = most;
  made_ = 0;
}

int LoadStepBound::left() const {
  return most_ > 0 ? std::max(1, most_ - made_) : std::numeric_limits<int>::max();
}

double LoadStepBound::bearableDepth() const {
  const double hurry = most_ > 0 ? static_cast<double>(made_) / most_ : 0.0;
  if (hurry < tuning::kUnhurried) return 0.0;
  const double part = std::min(1.0, (hurry - tuning::kUnhurried) / (1.0 - tuning::kUnhurried));
  return tuning::kBearableFirst + part * (tuning::kBearableLast - tuning::kBearableFirst);
}

}  // namespace robot_tissue
