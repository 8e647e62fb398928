// A model that derives from an energy: what a method needs that minimizes it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Second derivative of a cell's energy (N/m): rows and columns 3 * i + axis, i a corner, then the
// nodes that the cell reaches (reachedNodes), if any.
using CellHessian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMostReached, 3 * kMostReached>;
using CellVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMostReached, 1>;  // likewise

// What a node feels that moves while all others stand.
struct NodeBalance {
  Vec3 force = Vec3::Zero();                        // on it (N)
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();  // second derivative of the energy in it (N/m)
};

class EnergyModel : public TissueModel {
 public:
  // Of the shape, zero at rest (J); that of gravity included.
  virtual double energy(const LatticeState& state) const = 0;

  // nodeForce of every node at once (N): minus the energy's gradient.
  virtual std::vector<Vec3> nodeForces(const LatticeState& state) const = 0;

  // Length of the vector of all nodes' forces that hold on to nothing (N): of inertia and viscosity
  // in a time step, of a pressure inside.
  virtual double freeForceNorm(const LatticeState&) const { return 0.0; }

  // Part of the energy beside the cells; null: none.
  virtual std::shared_ptr<const Membrane> membrane() const { return nullptr; }

  virtual NodeBalance nodeBalance(const LatticeState& state, int node) const = 0;

  // Adds the forces of the cells (indices into state.cells->all()) on their nodes (N).
  virtual void addForces(const LatticeState& state, const std::vector<int>& cells,
                         std::vector<Vec3>& forces) const = 0;

  // Calls `visit` with the nodes (-1: none there) and the second derivative of every cell that has
  // energy, in a fixed order. Their sum is the energy's second derivative, but for the membrane's.
  using VisitHessian =
      std::function<void(const std::array<int, kMostReached>& nodes, const CellHessian& hessian)>;
  virtual void visitHessians(const LatticeState& state, const VisitHessian& visit) const = 0;
};

}  // namespace robot_tissue
