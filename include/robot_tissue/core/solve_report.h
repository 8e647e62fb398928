// What the solver says of itself.
#pragma once

#include <vector>

#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

// From good to bad.
enum class SolveStatus { kOk, kLate, kUnconverged, kInverted };
const char* toString(SolveStatus status);

struct SolveReport {
  SolveStatus status = SolveStatus::kOk;
  double wall_ms = 0.0;         // the solve alone
  int iterations = 0;           // sweeps of layers and repositionings of patches
  double residual = 0.0;        // greatest unbalanced node force over the greatest patch node force
  double error_estimate = 0.0;  // L2 of the moves that would balance each node alone, over L2 of u
  int active_nodes = 0;         // nodes that were loaded or checked for balance
  int layers = 0;               // layers that were raised
  double volume_ratio = 1.0;    // deformed / rest volume of the displayed surface
  int inverted_cells = 0;       // cells turned inside out
  std::vector<PatchAnswer> patches;
};

}  // namespace robot_tissue
