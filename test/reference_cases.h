// Reads test/data/reference and solves its cases on the lattice.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct ReferenceCase {
  std::string name;
  double poisson_ratio = 0.0;
  std::array<std::optional<double>, 3> displacement;  // of the patch (m), empty = free
  double force = 0.0;                                 // norm, N
  std::vector<Vec3> field;  // displacements (m) of a 5 mm lattice's nodes, x fastest
};

std::vector<ReferenceCase> readReferenceCases(const std::string& package);

// The block of a case on a lattice of this spacing (m), and its load.
TissueConfig referenceTissue(const ReferenceCase& reference, double spacing);
LoadStep referenceLoad(const ReferenceCase& reference);

struct ReferenceError {
  double force = 0.0;  // relative, signed
  double field = 0.0;  // relative, L2 over the reference's nodes
};
// The spacing must be 5 mm or a whole part of it. Throws when there is no equilibrium.
ReferenceError errorAgainst(const ReferenceCase& reference, const std::string& method,
                            double spacing);

}  // namespace robot_tissue
