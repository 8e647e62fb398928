// What the numbers of a suture may be: for the scene's step, the node's service and Tissue::suture.
#pragma once

#include <algorithm>

#include "robot_tissue/core/suture.h"

namespace robot_tissue {

constexpr double kSoftestSuture = 1e-6;   // N/m; the stiffest is kStiffestSuture
constexpr double kStrongestSuture = 1e9;  // N, of break_force

// m: the most that rest_length and bite may be. `tissue`: its box at rest; ten thousand times its
// largest extent, or of how far it is from the origin if that is more, as of other lengths.
inline double longestSuture(const Box& tissue) {
  return 1e4 * std::max({(tissue.max() - tissue.min()).maxCoeff(),
                         tissue.max().cwiseAbs().maxCoeff(), tissue.min().cwiseAbs().maxCoeff()});
}

}  // namespace robot_tissue
