// A small piece of the lattice around a force on the tissue, at rest: how far the tissue gives way
// there, as the lattice has it (own; doc/model.md, "Narrow contacts").
//
// Nodes that are up to two cells from the middle one, and not deep, move on their own. Those around
// and below them go as in a half-space under the force, so that how far the tissue gives way does
// not hang on what is on its other side: free, fixed or on a support, the lattice tells that right.
// What is fixed or held by loading patches, and not deep, stands.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <functional>
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

// Bits 1 << axis: components of the node that a loading patch holds, or moves in one piece;
// nothing: it is in none.
std::optional<std::uint8_t> axesHeldBy(const std::vector<LoadingPatch>& patches, int node);

class LocalLattice {
 public:
  // Of what the node that bears most is in; none where that is nothing.
  static std::optional<SurfaceModuli> moduliUnder(const std::vector<NodeWeight>& shares,
                                                  const CellSet& cells, const ElasticModel& model);
  // Whether it is around the node that bears most.
  bool isAround(const std::vector<NodeWeight>& shares, const LatticeState& state) const;
  // Goes to a force along the axis, as the tissue is. False where it can tell nothing: a share is
  // elsewhere, or the tissue is of several materials there. The model must be that of the lattice.
  bool take(const std::vector<NodeWeight>& shares, const Vec3& axis, const SurfaceModuli& moduli,
            const std::vector<LoadingPatch>& patches, const Lattice& lattice,
            const LatticeState& state, const ElasticModel& model);

  // All of the following are of the piece and the force taken.
  // How it is turned, with these displacements (m).
  Eigen::Matrix3d turn(const std::vector<Vec3>& displacement) const;
  // At rest: where the force is (m), and its unit direction.
  const Vec3& place() const { return place_; }
  const Vec3& inwards() const { return inwards_; }
  // Whether the tissue is thick enough, inwards, to go as a half-space.
  bool isDeep(const Lattice& lattice) const;
  // The way of what carries the force along its direction, at rest, for 1 N (m/N).
  double compliance(const std::vector<NodeWeight>& shares) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  static constexpr int kNone = -1;

  struct PieceNode {
    int node;
    Vec3 place;         // at rest (m)
    std::uint8_t held;  // bits 1 << axis
  };

  using HeldAt = std::function<std::uint8_t(int node)>;  // bits 1 << axis

  bool isAsHeld(const HeldAt& held_at) const;
  void findNodes(const Lattice& lattice, const CellSet& cells, const HeldAt& held_at);
  void holdDeep(const CellSet& cells, const ElasticModel& model);
  Matrix stiffness(const CellSet& cells, const ElasticModel& model);
  Eigen::VectorXd motionAround() const;
  bool isOfOneMaterial(const CellSet& cells, const ElasticModel& model) const;

  std::shared_ptr<const CellSet> cells_;
  double spacing_ = 0.0;  // m
  SurfaceModuli moduli_;
  int middle_ = -1;
  std::vector<PieceNode> nodes_;          // the middle, ring by ring, then those around them
  int moving_count_ = 0;                  // of nodes_, the first, that may move on their own
  std::unordered_map<int, int> numbers_;  // in nodes_
  std::vector<int> own_cells_;            // that have one that may move as a corner, ascending
  Vec3 place_ = Vec3::Zero();
  Vec3 inwards_ = Vec3::Zero();
  std::vector<bool> is_deep_;                 // of nodes_
  std::vector<std::array<int, 3>> unknowns_;  // of nodes_, per axis; kNone: not on its own
  int unknown_count_ = 0;
  Matrix coupling_;  // unknowns to what does not move on its own, 3 of each of nodes_
  Eigen::SimplicialLDLT<Matrix> factor_;
};

}  // namespace robot_tissue
