// The tissue's lattice and, above it, lattices of twice, four times ... its spacing: what is smooth
// and far is found on the coarse ones (nonlinear multigrid: Brandt 1977; its use for this cell:
// own).
//
// Nodes move as the trilinear mean of the coarse nodes around them, P; a coarse node starts where
// the node at its place is. On the coarse lattice the forces are those of its own cells plus a
// load, chosen such that at the start they are P^T of the fine lattice's. What holds a fine node
// holds the coarse node at its place, and ties those around it; springs hang on the means.
//
// Lengths in spacings of the finest lattice, forces in modulus() * spacing^2, as LatticeLevel.
#pragma once

#include <vector>

#include "robot_tissue/core/elastic_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_level.h"
#include "robot_tissue/core/level_transfer.h"
#include "robot_tissue/core/patch_motion.h"

namespace robot_tissue {

template <typename Real>
class LatticeLevels {
 public:
  // The workers, null for none, must outlive the levels.
  LatticeLevels(const Lattice& lattice, const ElasticModel& model, const CellSet& cells,
                Workers* workers);

  LatticeLevel<Real>& finest() { return levels_.front(); }
  const LatticeLevel<Real>& finest() const { return levels_.front(); }
  int entryOf(int node) const { return entries_[at(node)]; }
  double modulus() const { return modulus_; }  // E0 (Pa)

  // Takes over what holds the nodes, and gravity. The shape's contacts must stay where they are.
  void bind(const LoadedShape& shape, const PatchHold& hold);
  // Places patches by force, and takes their motion so far as done.
  void renewGroups(const LoadedShape& shape, const PatchHold& hold);
  // Nodes out of the finest lattice's box stay where they are.
  void confine(const LevelBox& box);
  // Whether nodes of which nothing is held are elsewhere than this lattice has them.
  bool setDisplacement(const std::vector<Vec3>& displacement,
                       const std::vector<std::uint8_t>& held);
  Vec3 displacementOf(int node) const;  // m

  // The smooth motion that goes with the finest lattice's forces, into `motion`.
  void findSmoothMotion();
  Field<Real> motion;  // zero where the coarse lattices went astray
  std::vector<GroupVector> group_motion;

 private:
  // From a level to the next coarser one.
  struct Step {
    LevelTransfer<Real> transfer;
    std::vector<int> sources;  // per coarse spring that stands for a fine one: that one
    Field<Real> start;         // displacement of the coarse nodes
    Field<Real> wanted;        // their forces
    std::vector<GroupVector> wanted_of_groups;
  };
  // What holds the nodes, as numbers that are compared.
  struct Bond {
    std::vector<std::uint8_t> held;
    std::vector<double> springs;

    bool operator==(const Bond& other) const {
      return held == other.held && springs == other.springs;
    }
  };

  std::vector<LevelCell> finestCells(const Lattice& lattice, const ElasticModel& model,
                                     const CellSet& cells);
  void weigh(const ElasticModel& model, const CellSet& cells);
  static Bond bondOf(const LoadedShape& shape, const PatchHold& hold);
  void bindFinest(const LoadedShape& shape, const PatchHold& hold);
  void renewSprings(const LoadedShape& shape, const PatchHold& hold);
  void bindCoarse(std::size_t level);
  void addTies(std::size_t level);
  void addTie(std::size_t level, int node, unsigned axes, int group, const Vec3& arm);
  std::vector<LevelSpring::Carrier> freeCarriers(
      std::size_t level, const std::vector<LevelSpring::Carrier>& fine) const;

  void correct(std::size_t level);
  void restrictTo(std::size_t coarse);
  void solveCoarse(std::size_t level);
  std::vector<GroupVector> groupMotion(std::size_t coarse) const;
  bool isFinite() const;
  void placeAll();

  std::vector<LatticeLevel<Real>> levels_;
  std::vector<Step> steps_;   // from level i to i + 1
  std::vector<int> entries_;  // per node of the tissue
  Field<Real> weight_;        // of the nodes; empty without gravity
  Bond bond_;
  double spacing_ = 1.0;
  double modulus_ = 1.0;
  std::vector<Field<Real>> motions_;  // per level, on their way to it
};

extern template class LatticeLevels<float>;
extern template class LatticeLevels<double>;

}  // namespace robot_tissue
