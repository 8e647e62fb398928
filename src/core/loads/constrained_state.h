// A shape under loads.
#pragma once

#include <vector>

#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A shape and the patches that go with it.
struct ConstrainedState {
  LatticeState state;
  std::vector<LoadingPatch> patches;
};

// Where a patch by force turns about, in this shape (m).
Vec3 centerOf(const LoadingPatch& patch);

}  // namespace robot_tissue
