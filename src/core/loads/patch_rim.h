// The rim of a loading patch: where its edge runs over the surface of the tissue, springs join it
// to the nodes next to the edge (own; doc/model.md, "The rim").
//
// Only flat patches have one: one node thick along an axis, on the surface. Where the tissue ends
// with the patch there is no rim.
#pragma once

#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

// In: the patch's closed box of rest positions (m) and its nodes. Out: the springs, with anchors at
// rest, ascending by node; none where the model has no moduli. Fixed nodes get none.
std::vector<RimSpring> rimOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const Box& box,
                             const std::vector<int>& nodes);

}  // namespace robot_tissue
