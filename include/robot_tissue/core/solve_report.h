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
  double wall_ms = 0.0;  // the solve alone
  // Of the method: cycles of `layered`, Newton steps, sweeps or steps over all nodes of `vbd`,
  // `xpbd` and `explicit`; of `paper` sweeps of layers and repositionings of patches.
  int iterations = 0;
  double residual = 0.0;  // greatest unbalanced node force over the greatest patch node force
  // L2 of the motion that the method says is left, over that of u; of `paper` of the moves that
  // would balance each node alone, a lower bound.
  double error_estimate = 0.0;
  // Nodes that were solved for; of `paper` those that were loaded or checked for balance.
  int active_nodes = 0;
  // Of `layered`, how many layers of nodes around what is loaded or disturbed are open, at most;
  // of `paper`, how many were raised; 0 of others.
  int layers = 0;
  double volume_ratio = 1.0;  // deformed / rest volume of the displayed surface
  int inverted_cells = 0;     // cells turned inside out
  std::vector<PatchAnswer> patches;
};

}  // namespace robot_tissue
