// The models and methods that there are, and what of a scene's keys they use. A new one is a line
// of a table in src/core/tissue/registry.cpp and nowhere else.
#pragma once

#include <string>
#include <vector>

namespace robot_tissue {

struct ModelTraits {
  bool has_poisson_ratio = true;
  bool has_spring_stiffness = false;  // as another way to give its stiffness
  bool hard_patches_only = false;     // its methods move patches in one piece, and nothing slides
  bool has_law = true;                // of strain, else springs are linear
  bool has_membranes = false;         // on its surface
};

struct MethodTraits {
  bool uses_tolerance = true;  // else it solves exactly
  bool uses_threads = false;   // else one
  bool turns_patches = true;   // that a force moves
  bool takes_membranes = false;
  double factor_bytes = 0.0;  // of memory for n nodes, over n^(4/3): of a sparse factor
  double grid_bytes = 0.0;    // of memory a cell of the grid around the lattice, filled or not
};

const std::vector<std::string>& modelNames();
const std::vector<std::string>& methodNames();
// Throw InputError: no model, no method of this name.
const ModelTraits& traitsOfModel(const std::string& model);
const MethodTraits& traitsOf(const std::string& method);

// The models that have what is asked for: "a, b".
std::string modelsWith(bool ModelTraits::*trait);

// The methods that take membranes: "a, b".
std::string methodsWithMembranes();

// The methods that fit the model; the first is the default.
std::vector<std::string> methodsFor(const std::string& model);

}  // namespace robot_tissue
