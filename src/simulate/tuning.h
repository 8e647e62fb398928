// The numbers of the runner in one place: unit, where each comes from, and what turning it does.
// Chosen: by judgment, and kept as the tests passed; no other value was measured against it.
#pragma once

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue::tuning {

// Load steps of one move; a longer one is refused. More: longer runs before the refusal. Chosen.
constexpr double kMostLoadSteps = 100000.0;
// Load steps that a tool goes at once where nothing is near. More: fewer updates in the open; from
// Pipeline::kMostLoadSteps on it is taken for a jump. Chosen: half of that.
constexpr double kLongestFree = Pipeline::kMostLoadSteps / 2.0;
// Updates until all pushed tools have met their forces. More: soft tissue is followed longer.
// Chosen.
constexpr int kMostUpdates = 50;
// Of the force (1): nearer than this to it, it is met. More: no remark on tools that slip away; the
// pipeline corrects to within its own kForceMet in any case. Chosen.
constexpr double kMetForce = 0.01;
// Load steps (1): 5 steps of a fifth are 5, not 6. Rounding.
constexpr double kStepRounding = 1e-9;

}  // namespace robot_tissue::tuning
