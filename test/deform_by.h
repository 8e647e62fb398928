// A lattice in a shape that is known: for tests and checks.
#pragma once

#include <Eigen/Core>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Moves every node to where the deformation gradient takes it.
inline void deformBy(const Lattice& lattice, const Eigen::Matrix3d& gradient, LatticeState& state) {
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    state.displacement[at(node)] = gradient * rest - rest;
  }
}

}  // namespace robot_tissue
