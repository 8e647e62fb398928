// How a loading patch holds a mesh whose surface stands between the lattice's nodes: springs join
// it to nodes on both sides of the surface, so that it acts as wide as its box (own; doc/model.md,
// "Shapes by a mesh").
#pragma once

#include <optional>
#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

// In: the patch's closed box of rest positions (m) and its nodes, ascending. Out: springs in place
// of those of a block's patch (patch_rim.h), ascending by node, anchors at rest; fixed nodes get
// none. Nothing: no cell in the box or beside it is filled in part.
std::optional<std::vector<RimSpring>> bedOf(const Lattice& lattice, const TissueModel& model,
                                            const LatticeState& state, const Box& box,
                                            const std::vector<int>& nodes);

}  // namespace robot_tissue
