// A lattice of twice the spacing, laid over the tissue: it tells which smooth motion of all nodes
// goes with forces on them (own).
//
// Nodes move as the trilinear mean of the coarse nodes around them, u = P U, and those that are
// hard in a patch by force with that. The coarse matrix is P^T A P, with A the energy's second
// derivative at rest, less the rows and columns of held components: holes, regions, shares of cells
// and cuts come with it. It is factorized once for a set of cells and of held nodes.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/energy_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/patch_motion.h"
#include "robot_tissue/core/sparse_factor.h"

namespace robot_tissue {

class CoarseLattice {
 public:
  CoarseLattice(const Lattice& lattice, const EnergyModel& model);

  // Costs nothing when cells, held components and rims are those of the last call.
  void build(const LoadedShape& shape, const PatchHold& hold);

  // Builds anew at the next call, from rest.
  void forget() { cells_.reset(); }

  // Takes the second derivative at this shape from now on; at rest when it has none that holds.
  void renew(const LoadedShape& shape, const PatchHold& hold);

  // Motion of the nodes and of patches by force under forces on them. Held components do not move.
  void solve(const Motion& forces, const LoadedShape& shape, const PatchHold& hold,
             Motion& motion) const;

 private:
  using Weights = std::array<std::array<double, kCorners>, kCorners>;  // [fine corner][coarse one]

  // A coarse cell: its eight coarse nodes and the second derivative of the cells in it.
  struct Block {
    std::array<int, kCorners> coarse{};
    std::vector<int> cells;  // indices into CellSet::all()
    CellHessian matrix = CellHessian::Zero();
  };
  // Where a node sits: weights of the coarse nodes of its block.
  struct Place {
    int block = -1;
    std::array<double, kCorners> weight{};
  };

  bool fillChanged(const LoadedShape& shape, const PatchHold& hold);
  void sumBlocks();
  void assemble(const LoadedShape& shape, const PatchHold& hold);
  void lay(const LatticeState& state);
  void fill(Block& block, const LatticeState& rest, const PatchHold& hold);
  bool isCarried(const Cell& cell, const PatchHold& hold) const;
  void addCarried(const LoadedShape& shape, const LatticeState& rest, const PatchHold& hold);
  void addRims(const LoadedShape& shape, const PatchHold& hold);
  void addContacts(const LoadedShape& shape, const PatchHold& hold);
  void numberPatches(const LoadedShape& shape);
  void factorize();

  // A node's motion as a sum of 3x3 weights times groups of three unknowns.
  struct Share {
    int group = 0;
    Eigen::Matrix3d weight;
  };
  std::vector<Share> sharesOf(const LoadedShape& shape, const PatchHold& hold, int node) const;
  void add(const std::vector<Share>& rows, const std::vector<Share>& columns,
           const Eigen::Matrix3d& block);

  const Lattice& lattice_;
  const EnergyModel& model_;
  std::shared_ptr<const CellSet> cells_;
  std::vector<std::uint8_t> held_;
  std::vector<int> carriers_;
  std::vector<double> springs_;  // of rims and contacts: nodes and stiffnesses
  LatticeState about_;           // the shape whose second derivative it is
  std::vector<Block> blocks_;
  std::vector<Place> places_;
  std::vector<int> first_group_;  // per patch: of its shift, then its turn; -1 = none
  int coarse_count_ = 0;
  int groups_ = 0;  // of three unknowns
  bool usable_ = false;
  Eigen::SparseMatrix<double> sum_;     // of the blocks, lower triangle
  Eigen::SparseMatrix<double> matrix_;  // and of patches
  std::vector<Eigen::Triplet<double>> entries_;
  SparseFactor factor_;
};

}  // namespace robot_tissue
