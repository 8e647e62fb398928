#include "robot_tissue/core/rim_law.h"

#include <limits>

namespace robot_tissue {

RimLaw rimLaw(double poisson_ratio) {
  return {{0.20, 3.61}, {0.25, 3.3 + 4.7 * poisson_ratio}, {0.155, 3.3 + 12.25 * poisson_ratio}};
}

double rimStiffness(const RimMode& mode, double depth) {
  if (depth >= mode.shift) return std::numeric_limits<double>::infinity();
  if (depth <= mode.shift - 1.0) return 0.0;
  return mode.stiffness * (depth + 1.0 - mode.shift) / (1.0 - mode.shift) * mode.shift /
         (mode.shift - depth);
}

}  // namespace robot_tissue
