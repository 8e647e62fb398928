// What holds the nodes together: the force on a node for a given shape. Implementations are
// constant after construction; the shape is an argument.
#pragma once

#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class TissueModel {
 public:
  virtual ~TissueModel() = default;

  // Net force on the node (N, tissue frame), gravity included; zero in equilibrium.
  virtual Vec3 nodeForce(const LatticeState& state, int node) const = 0;

  // Stiffness against moving this node alone, at rest, along x, y and z (N/m); zero along an axis
  // that nothing resists.
  virtual Vec3 nodeStiffness(const LatticeState& state, int node) const = 0;
};

}  // namespace robot_tissue
