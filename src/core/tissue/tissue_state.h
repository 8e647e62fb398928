#pragma once

#include <cstdint>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Of what the balance of a shape hangs on beside the lattice and the loads.
std::uint64_t balanceFingerprint(const TissueConfig& tissue, const SolverConfig& solver);

}  // namespace robot_tissue
