// The bed of a loading patch on a mesh: where the patch's nodes stand outside of the surface,
// springs join it to the nodes across the layer of material between (own; doc/model.md, "Shapes by
// a mesh").
#pragma once

#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

// In: the patch's closed box of rest positions (m) and its nodes, ascending. Out: what a layer of
// thickness t under the box lacks to be as stiff as it is (core/lattice/held_layers.h), of a full
// cell's stiffness 1 / t - t. Ascending by node, anchors at rest; none where the model has no
// moduli.
std::vector<RimSpring> bedOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const Box& box,
                             const std::vector<int>& nodes);

}  // namespace robot_tissue
