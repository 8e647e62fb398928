// A small piece of the lattice around a force on the tissue, at rest: how far the tissue gives way
// there, as the lattice has it (own; doc/model.md, "Narrow contacts").
//
// Nodes that are up to two cells from the middle one move, those around them stand, as fixed ones
// and those of loading patches do. What is missing for that is as of a flat surface that goes on.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "loads/narrow_contact.h"
#include "material/elastic_model.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Per node, bits 1 << axis: components that a loading patch holds, or moves in one piece.
using HeldAxes = std::map<int, std::uint8_t>;

HeldAxes axesHeldBy(const std::vector<LoadingPatch>& patches);

class LocalLattice {
 public:
  // Of what the node that bears most is in; none where that is nothing.
  static std::optional<SurfaceModuli> moduliUnder(const std::vector<NodeWeight>& shares,
                                                  const CellSet& cells, const ElasticModel& model);
  // Whether it is around the node that bears most.
  bool isAround(const std::vector<NodeWeight>& shares, const LatticeState& state) const;
  // Goes there, if it is not. False where it can tell nothing: a share is elsewhere, or the tissue
  // is of several materials there. The model must be that of the lattice.
  bool take(const std::vector<NodeWeight>& shares, const SurfaceModuli& moduli,
            const HeldAxes& held_axes, const Lattice& lattice, const LatticeState& state,
            const ElasticModel& model);

  // All of the following are of the piece taken.
  // How it is turned, with these displacements (m).
  Eigen::Matrix3d turn(const std::vector<Vec3>& displacement) const;
  // Whether there is tissue two spacings inwards from a place (at rest, m).
  bool isDeepAt(const Vec3& place, const Vec3& inwards) const;
  // The way of what carries the force along its unit direction, at rest, for 1 N (m/N).
  double compliance(const std::vector<NodeWeight>& shares, const Vec3& direction) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  static constexpr int kNone = -1;

  void make(int middle, const Lattice& lattice, const CellSet& cells, const ElasticModel& model);
  void findNodes(const Lattice& lattice, const CellSet& cells);
  void addNode(int node, const Lattice& lattice, const CellSet& cells);
  Matrix stiffness(const CellSet& cells, const ElasticModel& model) const;
  bool isOfOneMaterial(const CellSet& cells, const ElasticModel& model) const;

  std::shared_ptr<const CellSet> cells_;
  double spacing_ = 0.0;  // m
  SurfaceModuli moduli_;
  int middle_ = -1;
  std::vector<int> nodes_;    // that move: the middle, then ring by ring
  std::vector<Vec3> places_;  // of nodes_, at rest (m)
  HeldAxes held_axes_;
  std::unordered_map<int, std::array<int, 3>> unknowns_;  // of nodes_, per axis; kNone: it is held
  int unknown_count_ = 0;
  std::vector<int> own_cells_;  // that have one of them as a corner, ascending
  Eigen::SimplicialLDLT<Matrix> factor_;
};

}  // namespace robot_tissue
