// How a tool that tissue sticks to holds it: as a loading patch does, by hard nodes and by springs
// where its face ends and where the surface stands between the lattice's nodes (own; doc/model.md,
// "The rim" and "Shapes by a mesh").
#pragma once

#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

// In: the nodes that go with the tool, ascending. Out: springs to those that are not hard,
// ascending, without anchors; of those that it does not hold at all their stiffness is zero. None
// where the model has no moduli, or the nodes are at no surface.
std::vector<RimSpring> bedOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const std::vector<SeatedNode>& nodes);

}  // namespace robot_tissue
