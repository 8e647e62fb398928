// How far two sets of a lattice's cells differ.
#pragma once

#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Cells and parts of cells that only one of them has, over those of the larger one. Parts with the
// same corners are the same, wherever in the cell a blade passed.
double shareChanged(const CellSet& one, const CellSet& other);

}  // namespace robot_tissue
