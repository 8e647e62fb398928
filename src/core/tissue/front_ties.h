// What holds the fronts of cuts together, as a solve has it.
#pragma once

#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

std::vector<ContactSpring> tiesOfFronts(const Lattice& lattice, const LatticeState& state,
                                        const TissueModel& model);

}  // namespace robot_tissue
