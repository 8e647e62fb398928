#pragma once

#include "surface/mesh_surface.h"

namespace robot_tissue {

// meshSurface of a lattice with severed springs.
TissueSurface cutMeshSurface(const Lattice& lattice, const LatticeState& state,
                             const TriangleMesh& mesh);

}  // namespace robot_tissue
