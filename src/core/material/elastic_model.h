// Model `elastic`: an isotropic material with moduli in Pa, a cell of the lattice at a time
// (core/material/elastic_cell.h, doc/model.md).
//
// Cells are LatticeState::cells; ghosts are nodes like others. Membranes have their share in all
// that is of nodes; what is of cells is without them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "material/elastic_cell.h"
#include "material/energy_model.h"
#include "material/inertial_term.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/sparse_values.h"

namespace robot_tissue {

class ElasticModel : public EnergyModel {
 public:
  // The lattice, made of the same config, must outlive the model.
  ElasticModel(const Lattice& lattice, const TissueConfig& config);

  SplitCells splitCells() const override { return SplitCells::kParted; }
  bool resistsInversion() const override { return true; }
  Vec3 nodeForce(const LatticeState& state, int node) const override;
  std::vector<Vec3> forcesOn(const LatticeState& state,
                             const std::vector<int>& nodes) const override;
  Vec3 weight(const LatticeState& state) const override;
  Vec3 nodeStiffness(const LatticeState& state, int node) const override;
  Moduli moduliAt(const LatticeState& state, int node) const override;
  Moduli moduliIn(const Cell& cell) const override { return cellModuli(cell); }
  double energy(const LatticeState& state) const override;
  std::vector<Vec3> nodeForces(const LatticeState& state) const override;
  NodeBalance nodeBalance(const LatticeState& state, int node) const override;
  void addForces(const LatticeState& state, const std::vector<int>& cells,
                 std::vector<Vec3>& forces) const override;
  // The same without gravity and time step.
  void addElasticForces(const LatticeState& state, const std::vector<int>& cells,
                        std::vector<Vec3>& forces) const;
  void visitHessians(const LatticeState& state, const VisitHessian& visit) const override;
  double freeForceNorm(const LatticeState& state) const override;
  int cellsBeyondLaw(const LatticeState& state) const override;
  void setInertia(const InertialTerm* inertia) override { inertia_ = inertia; }
  void setMembrane(std::shared_ptr<const Membrane> membrane) override {
    membrane_ = std::move(membrane);
    node_stiffness_of_.reset();
  }
  std::shared_ptr<const Membrane> membrane() const override { return membrane_; }

  // Second derivative of the cell's energy at rest (N/m), without a time step.
  CellHessian stiffnessAtRest(const Cell& cell) const;
  // Second derivative of the energy in this node alone (N/m).
  Eigen::Matrix3d nodeBlock(const LatticeState& state, int node) const;

  ElasticCell shaped(const LatticeState& state, const Cell& cell) const;
  Moduli cellModuli(const Cell& cell) const;  // Pa, of what the cell is filled with
  // Gravity on what the corner bears of the cell (N), and its mass (kg).
  Vec3 cornerWeight(const Cell& cell, int corner) const;
  double cornerMass(const Cell& cell, int corner) const;
  std::vector<Vec3> cellForces(const LatticeState& state) const;  // no gravity, no time step (N)
  std::vector<double> nodeMasses(const CellSet& cells) const;     // ghosts last (kg)
  bool hasMembranes() const { return has_membranes_; }            // the scene has, at least
  bool movesInTime() const { return moves_in_time_; }       // solves may have an inertial term
  const InertialTerm* inertia() const { return inertia_; }  // null: none

 private:
  struct Substance {
    Moduli moduli;
    Vec3 corner_weight = Vec3::Zero();  // gravity on an eighth of a full cell (N)
    double corner_mass = 0.0;           // of such an eighth (kg)
  };
  const Substance& substanceOf(const Cell& cell) const {
    return substances_[lattice_.compositionOf(cell)];
  }

  bool dampsStrain() const { return inertia_ != nullptr && inertia_->dampsStrain(); }
  void damp(const Cell& cell, ElasticCell& shape) const;
  Moduli stepModuli(const Cell& cell) const;                 // with what a time step adds
  double cornerInertia(const Cell& cell, int corner) const;  // N/m; zero without a time step
  void addInertia(const Cell& cell, CellHessian& hessian) const;
  Vec3 inertialForce(int node) const;  // that does not hang on the shape (N)
  Vec3 forceOf(const Cell& cell, const ElasticCell& shape, int corner,
               const Vec3& displacement) const;  // N
  void addShaped(const LatticeState& state, const CellSet::Meeting& met,
                 NodeBalance& balance) const;
  double stiffnessAtRest(const CellSet& cells, int node) const;  // N/m

  const Lattice& lattice_;
  bool moves_in_time_;
  const InertialTerm* inertia_ = nullptr;
  bool has_membranes_;
  std::shared_ptr<const Membrane> membrane_;  // null: none
  std::vector<Substance> substances_;         // per composition of the lattice
  // Of nodes that were asked for (N/m), and the cells that it is of. Touches ask in every round.
  mutable SparseValues<double> node_stiffness_;
  mutable std::shared_ptr<const CellSet> node_stiffness_of_;
};

}  // namespace robot_tissue
