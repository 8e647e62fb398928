// What holds the nodes together: the force on a node for a given shape. Implementations are
// constant after construction, but for the time step; the shape is an argument.
#pragma once

#include <memory>
#include <vector>

#include "config/material.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class Membrane;
struct InertialTerm;

class TissueModel {
 public:
  virtual ~TissueModel() = default;

  // Net force on the node (N, tissue frame), gravity included; zero in equilibrium. In a time step
  // that of inertia and of viscosity, too.
  virtual Vec3 nodeForce(const LatticeState& state, int node) const = 0;

  // nodeForce of each of these nodes, none of which is told twice.
  virtual std::vector<Vec3> forcesOn(const LatticeState& state,
                                     const std::vector<int>& nodes) const {
    std::vector<Vec3> forces;
    for (const int node : nodes) forces.push_back(nodeForce(state, node));
    return forces;
  }

  // Stiffness against moving this node alone, at rest, along x, y and z (N/m); zero along an axis
  // that nothing resists.
  virtual Vec3 nodeStiffness(const LatticeState& state, int node) const = 0;

  // Of all that there is (N).
  virtual Vec3 weight(const LatticeState& state) const = 0;

  // A model of cells needs their parts; one of springs needs no ghosts, which have none.
  virtual SplitCells splitCells() const { return SplitCells::kLost; }

  // Whether a cell that is pressed flat pushes back: else cells turn inside out without a force.
  virtual bool resistsInversion() const { return false; }

  // Moduli behind a node of the surface: a quarter of the sum over its cells, so the material's own
  // where it meets four full ones. Zero where the model has none.
  virtual Moduli moduliAt(const LatticeState&, int) const { return {}; }

  // Of the cell, of what it is filled with. Zero where the model has none.
  virtual Moduli moduliIn(const Cell&) const { return {}; }

  // Cells so strained that the law goes on otherwise there than it is told to (elastic_law.h).
  virtual int cellsBeyondLaw(const LatticeState&) const { return 0; }

  // Energy and forces are those of a time step from now on; null: of the shape alone. The term must
  // live so long.
  virtual void setInertia(const InertialTerm*) {}

  // Energy and forces have those of these membranes, too, from now on; null: none.
  virtual void setMembrane(std::shared_ptr<const Membrane>) {}  // NOLINT: kept by who overrides it
};

}  // namespace robot_tissue
