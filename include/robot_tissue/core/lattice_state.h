// Data between stages, 4 of 4: the shape, and what the solver says of itself.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct LatticeState {
  std::vector<Vec3> displacement;     // per node, the ghosts last, from rest (m)
  std::vector<std::uint8_t> severed;  // per spring, 1 = cut
  int springs_cut = 0;
  std::shared_ptr<const CellSet> cells;  // what the cuts left of the lattice's
  int pieces = 1;                        // parts of the lattice that springs hold together
};

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
