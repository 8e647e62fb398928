// The models and methods that exist. A new one is added in registry.cpp and nowhere else.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/solver_method.h"
#include "robot_tissue/core/tissue_model.h"

namespace robot_tissue {

const std::vector<std::string>& modelNames();
const std::vector<std::string>& methodNames();

// The methods that fit the model; the first is the default.
std::vector<std::string> methodsFor(const std::string& model);

// Both throw InputError on an unknown name, the second also on a model that the method does
// not fit. The model must outlive the method, the lattice both.
std::unique_ptr<TissueModel> makeModel(const TissueConfig& config, const Lattice& lattice);
std::unique_ptr<SolverMethod> makeMethod(const SolverConfig& config, const Lattice& lattice,
                                         const TissueModel& model);

}  // namespace robot_tissue
