// The parts of a state of the lattice as bytes and back. What is taken is checked: it throws
// InputError for what no cut, removal or solve could have left.
#pragma once

#include <cstddef>
#include <memory>

#include "cutting/split_cells.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "saving/bytes.h"

namespace robot_tissue {

void putSevered(const LatticeState& state, ByteWriter& out);
void takeSevered(std::size_t springs, LatticeState& state, ByteReader& in);

// Of severed springs, in ascending order.
void putPartings(const LatticeState& state, ByteWriter& out);
void takePartings(LatticeState& state, ByteReader& in);

void putFronts(const LatticeState& state, ByteWriter& out);
void takeFronts(const Lattice& lattice, LatticeState& state, ByteReader& in);

void putRemovals(const LatticeState& state, ByteWriter& out);
void takeRemovals(const Lattice& lattice, LatticeState& state, ByteReader& in);

void putGhosts(const Lattice& lattice, SplitCells split, const LatticeState& state,
               ByteWriter& out);
std::shared_ptr<const CellSet> takeCells(const Lattice& lattice, SplitCells split,
                                         const LatticeState& state, ByteReader& in);

// Tissue that nothing holds may have fallen far.
void takeDisplacement(const Lattice& lattice, LatticeState& state, ByteReader& in);

}  // namespace robot_tissue
