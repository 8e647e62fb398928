// Makes the models and methods that exist (robot_tissue/core/method_names.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/core/scene.h"
#include "solvers/solver_method.h"

namespace robot_tissue {

// Both throw InputError on an unknown name, the second also on a model that the method does
// not fit. The model must outlive the method, the lattice both.
std::unique_ptr<TissueModel> makeModel(const TissueConfig& config, const Lattice& lattice);
std::unique_ptr<SolverMethod> makeMethod(const SolverConfig& config, const Lattice& lattice,
                                         const TissueModel& model);

}  // namespace robot_tissue
