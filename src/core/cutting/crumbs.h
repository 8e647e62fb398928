// Crumbs (own): nodes that hold together, and around which there is no tissue in any cell: none in
// their eighths, or none up to where a blade passed. Cells that a mesh fills in part have nodes
// outside the mesh; where a blade took all springs from such a node, a piece would be left of which
// nothing can be seen. So crumbs stay with what is beside them.
#pragma once

#include <cstdint>
#include <vector>

#include "cutting/blade_surface.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Without the springs, none of which is severed yet, that would leave crumbs: each keeps those to
// the part beside it to which it has the most of them, to one with tissue where there is one.
std::vector<Crossing> sparingCrumbs(const Lattice& lattice, const LatticeState& state,
                                    std::vector<Crossing> crossings);

// Of each of the lattice's cells the eighths that are to be removed (bits), with those of the
// crumbs that this would leave.
std::vector<std::uint8_t> withCrumbs(const Lattice& lattice, const LatticeState& state,
                                     std::vector<std::uint8_t> cells);

}  // namespace robot_tissue
