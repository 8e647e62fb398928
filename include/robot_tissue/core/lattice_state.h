// Data between stages, 4 of 4: the shape.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct LatticeState {
  std::vector<Vec3> displacement;     // per node, the ghosts last, from rest (m)
  std::vector<std::uint8_t> severed;  // per spring, 1 = cut
  int springs_cut = 0;
  std::shared_ptr<const CellSet> cells;  // what the cuts left of the lattice's
  int pieces = 1;                        // parts of the lattice that springs hold together
};

}  // namespace robot_tissue
