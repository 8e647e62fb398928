// Model `elastic`: an isotropic material with moduli in Pa, a cell of the lattice at a time
// (core/elastic_cell.h, doc/model.md).
//
// A cell that a cut has split, that is, whose corners uncut springs no longer hold together, is
// lost: it has no energy and no stiffness. A node without a whole cell is loose: no force acts on
// it, not even its weight, and its stiffness is zero.
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/elastic_cell.h"
#include "robot_tissue/core/energy_model.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue {

class ElasticModel : public EnergyModel {
 public:
  // The lattice, made of the same config, must outlive the model.
  ElasticModel(const Lattice& lattice, const TissueConfig& config);

  Vec3 nodeForce(const LatticeState& state, int node) const override;
  Vec3 nodeStiffness(const LatticeState& state, int node) const override;
  double energy(const LatticeState& state) const override;
  std::vector<Vec3> nodeForces(const LatticeState& state) const override;
  void visitHessians(const LatticeState& state, const VisitHessian& visit) const override;

  // Second derivative of the energy in this node alone (N/m).
  Eigen::Matrix3d nodeBlock(const LatticeState& state, int node) const;

 private:
  using CellIndex = std::array<int, 3>;
  struct CellAt {
    CellModuli moduli;
    std::array<int, kCorners> corners;
  };

  CellAt cellAt(const CellIndex& index) const;
  bool isWhole(const LatticeState& state, const CellAt& cell) const;
  ElasticCell shaped(const LatticeState& state, const CellAt& cell) const;
  // Calls visit(cell) for every whole cell.
  template <typename Visit>
  void visitWholeCells(const LatticeState& state, const Visit& visit) const;
  // Calls visit(cell, corner) for every whole cell that has the node as a corner.
  template <typename Visit>
  void visitWholeCellsAt(const LatticeState& state, int node, const Visit& visit) const;

  const Lattice& lattice_;
  Vec3 gravity_;
  CellIndex cells_;                 // along x, y, z
  std::vector<CellModuli> moduli_;  // per cell, x running fastest
};

}  // namespace robot_tissue
