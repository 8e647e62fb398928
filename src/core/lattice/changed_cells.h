// How far two sets of a lattice's cells differ.
#pragma once

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue {

// Cells and parts of cells that only one of two sets has. Parts with the same corners are the same,
// wherever in the cell a blade passed.
struct ChangedCells {
  double share = 0.0;  // over the cells of the larger set
  GridBox box;         // points of the lattice around them; empty: there are none
};
ChangedCells changedCells(const Lattice& lattice, const CellSet& one, const CellSet& other);

}  // namespace robot_tissue
