// Removing tissue (own; the paper removes nodes): whole cells, and parts that cuts made of cells.
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/removed_space.h"

namespace robot_tissue {

// Bits of the eighths to be removed, for each cell of the lattice: those of every cell, or part of
// one, whose center is in the space as the shape is now, and that is still there. Empty: none is.
// Throws InputError for a space that is not finite or empty.
std::vector<std::uint8_t> cellsWithin(const Lattice& lattice, const LatticeState& state,
                                      const RemovedSpace& space);

// Takes them out of the state. Springs along which nothing is left are severed, nodes around which
// nothing is left come back to rest; a ghost stays with what has it.
void removeCells(const Lattice& lattice, const std::vector<std::uint8_t>& cells, SplitCells split,
                 LatticeState& state);

// Nodes around which nothing is left have no displacement.
void restRemoved(LatticeState& state);

// Of nodes and ghosts that were gone in `before` and are there again in `state`: they are moved as
// those beside them in their cells are, so that what comes back is where its surroundings went, on
// each side of a cut where that side went.
void moveWithNeighbors(const Lattice& lattice, const LatticeState& before, LatticeState& state);

// Sets what hangs on `taken` alone: which springs are severed with it, and `left`.
void noteTaken(const Lattice& lattice, LatticeState& state);

// Whether no part of a cell was removed without the rest of that part.
bool isOfWholeParts(const Lattice& lattice, const LatticeState& state);

// Nodes of the lattice at the cells' corners around which something is left.
std::vector<int> nodesAround(const Lattice& lattice, const std::vector<std::uint8_t>& cells,
                             const LatticeState& state);

// Of the cells' material (m^3).
double volumeOf(const Lattice& lattice, const LatticeState& state,
                const std::vector<std::uint8_t>& cells);

}  // namespace robot_tissue
