// Which nodes of a lattice hold together.
#pragma once

#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Number of parts that uncut springs hold together.
int countPieces(const Lattice& lattice, const LatticeState& state);

// None of them came apart as these springs, the last that were, were severed: around them, what
// hung together still does. False: that is not known.
bool holdTogether(const Lattice& lattice, const LatticeState& state,
                  const std::vector<int>& severed);

// Of each node, the ghosts last: the number of its part, from 0 on, in the order of the parts'
// lowest nodes; -1: it was removed. A ghost is of the part whose cell has it, -1 where that lost
// its nodes.
std::vector<int> pieceOfNodes(const Lattice& lattice, const LatticeState& state);

}  // namespace robot_tissue
