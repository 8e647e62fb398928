// Cells that a cut has split, and the ghosts of their parts (virtual nodes: Molino, Bao, Fedkiw
// 2004; which ghosts are one, what a part weighs and what is fixed: own).
//
// Severed springs part a cell where its corners no longer hang together. Every part becomes a cell
// with 8 corners, filled where its own corners have the cell's material: up to where the blade
// passed through the springs (cell_division.h). So no volume is lost, and it is the volume that the
// displayed surface encloses; a part of less than a thousandth of the cell counts as one.
//
// A part lost corners. Its ghosts there are shared with parts of neighboring cells that it hangs
// together with: parts that own a common corner in the face between the cells have one and the same
// node at all four corners of that face. Where the neighbor owns what the part lost, at the end of
// a cut, that is the lattice's node: the cut is closed there. Parts that springs do not join, over
// however many cells, have no node in common.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// For each corner the lowest corner of the part of the cell it belongs to; corners that uncut
// springs of the cell join are in one part. All zero in a whole cell.
std::array<int, kCorners> cellParts(const Lattice& lattice, const LatticeState& state,
                                    const std::array<int, kCorners>& corners);

// What a part has of its cell's h^3 at least: a thousandth, or an eighth of what there is. The
// greatest part has so much less.
double leastShare(const Cell& cell);

bool isOnePart(const std::array<int, kCorners>& parts);

// What the severed springs, and what was removed, leave of the lattice's cells. Ghosts of
// state.cells keep their numbers.
std::shared_ptr<const CellSet> cellsLeft(const Lattice& lattice, const LatticeState& state,
                                         SplitCells split);
// The same where state.cells are what there was before these springs were severed, and nothing else
// has changed since: the parts of cells beside none of them are known.
std::shared_ptr<const CellSet> cellsLeft(const Lattice& lattice, const LatticeState& state,
                                         SplitCells split, const std::vector<int>& severed);

// Displacements (m) for the nodes of `to`, from those for `from`, an earlier or later set of the
// same lattice. A new ghost starts where the node was that stood there before the cut: every part
// begins with the deformation that its cell had.
std::vector<Vec3> carriedOver(const CellSet& from, const std::vector<Vec3>& displacement,
                              const CellSet& to);

}  // namespace robot_tissue
