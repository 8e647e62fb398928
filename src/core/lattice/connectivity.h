// Which nodes of a lattice hold together.
#pragma once

#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Number of parts that uncut springs hold together.
int countPieces(const Lattice& lattice, const LatticeState& state);

// Of each node, the ghosts last: the number of its part, from 0 on, in the order of the parts'
// lowest nodes; -1: it was removed. A ghost is of the part whose cell has it.
std::vector<int> pieceOfNodes(const Lattice& lattice, const LatticeState& state);

}  // namespace robot_tissue
