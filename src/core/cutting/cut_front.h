// Where a cut ends inside the tissue (own; doc/model.md, "Where a cut ends").
//
// A cell that a blade has entered, but not parted, is at the front of the cut: some of its springs
// are severed, and the blade's surface goes on between whole ones, the springs ahead. Such a cell
// is parted along that surface, too. Its parts hold together at the ends of the springs ahead, and
// where the severed ones are by ties, as far as the blade left something whole there.
#pragma once

#include <array>
#include <vector>

#include "cutting/blade_surface.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Null: the spring is none ahead.
const SpringAhead* aheadAt(const LatticeState& state, int spring);

// For each corner of a cell that severed springs leave whole the lowest corner on its side of the
// blade's surface; all zero where the cell is not at a front.
std::array<int, kCorners> frontParts(const Lattice& lattice, const LatticeState& state,
                                     const Cell& cell);

// The springs ahead, once these springs, the blade's, are severed: those that were there, as near
// as the blade has come to them since, and new ones. Of cells that have tissue at all corners; a
// cell whose severed springs no plane along the blade parts stays as it is.
std::vector<SpringAhead> springsAhead(const Lattice& lattice, const LatticeState& state,
                                      const BladeSurface& blade,
                                      const std::vector<Crossing>& severed);
// Without those that no cell at a front has.
std::vector<SpringAhead> stillAhead(const Lattice& lattice, const LatticeState& state);
// Of the same springs: the blade has come nearer to any.
bool haveComeNearer(const std::vector<SpringAhead>& before, const std::vector<SpringAhead>& now);

// What holds the parts of a cell together at a severed spring.
struct FrontTie {
  int place = 0;                     // of the cell
  double depth = 0.0;                // how far the blade's end is beyond, in spacings: 0 to -1
  std::vector<NodeWeight> carriers;  // of the way from one part to the other: weights sum to 0
};

// One for each side of a cell at a front on which the blade's end is, half a spacing of it each.
std::vector<FrontTie> frontTies(const Lattice& lattice, const LatticeState& state);

}  // namespace robot_tissue
