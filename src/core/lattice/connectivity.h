// Which nodes of a lattice hold together.
#pragma once

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Number of parts that uncut springs hold together.
int countPieces(const Lattice& lattice, const LatticeState& state);

}  // namespace robot_tissue
