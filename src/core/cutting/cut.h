// Cutting (own; the paper names it as future work): a polygon swept by a blade severs the springs
// that cross it in the deformed shape.
#pragma once

#include <vector>

#include "cutting/blade_surface.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Of a severed spring's length (1): what both ends keep, so that every part of a cell has some of
// it. More: a cut along nodes lies farther beside the blade; less than the slack below: nothing, as
// nodes so near are on the blade. Chosen.
constexpr double kEnd = 1e-3;

// Springs, not yet severed, that cross the polygon (3 or more corners in order, m, tissue frame).
// A node on the polygon's plane, within a thousandth of the spacing, counts as on the side that
// the normal points to (right-handed along the corners), so that each spring is cut once or not. A
// polygon that is not flat to that is cut as triangles (BladeSurface). Where in a spring the plane
// passes is told without that slack.
// Throws InputError: fewer than 3 corners, not finite, or no area.
std::vector<Crossing> springsAcross(const Lattice& lattice, const LatticeState& state,
                                    const std::vector<Vec3>& corners);

// The springs alone, without the cells: of a state that is only looked at.
void severSprings(const std::vector<Crossing>& crossings, LatticeState& state);

// Severs the springs, none of which is severed yet, where the blade crosses them, and the cells
// with them; new ghosts are put behind the other nodes of state.displacement. A spring keeps a
// thousandth of its length at both ends, so that every part of a cell has some of it.
void sever(const Lattice& lattice, const std::vector<Crossing>& crossings, LatticeState& state,
           SplitCells split = SplitCells::kLost);

// The same of a blade, whose front is kept (cut_front.h).
void sever(const Lattice& lattice, const std::vector<Crossing>& crossings,
           const BladeSurface& blade, LatticeState& state, SplitCells split);

// What no blade severs parts half way along it.
std::vector<Crossing> halfWay(const std::vector<int>& springs);

}  // namespace robot_tissue
