// The ranges of the node's own numbers; those of the scene's are in scene/ranges.h.
#pragma once

#include "robot_tissue/scene/entry.h"

namespace robot_tissue::ranges {

inline Range rate() { return {0.01, 1e4, "Hz"}; }
inline Range wrenchRate() { return {0.0, 1e3, "Hz"}; }  // 0: one an update
constexpr double kLeastWrenchRate = 0.01;               // Hz, of one that is not 0
inline Range poseTimeout() { return {1e-3, 1e6, "s"}; }
inline Range diagnosticPeriod() { return {1e-2, 1e6, "s"}; }
inline Range forceScale() { return {1e-9, 1e9, "m/N"}; }

}  // namespace robot_tissue::ranges
