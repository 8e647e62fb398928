// The unknowns of an equilibrium: which components of which nodes are free to move, which move as
// one, and how patches by force move them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "loads/constrained_state.h"
#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

class DofMap {
 public:
  static constexpr int kHeld = -1;

  // A component's motion is the sum of weight * unknown.
  struct Share {
    int unknown = kHeld;
    double weight = 0.0;
  };
  struct Shares {
    std::array<Share, 3> all;
    int count = 0;
    const Share* begin() const { return all.data(); }
    const Share* end() const { return all.data() + count; }
    void add(int unknown, double weight) { all[at(count++)] = {unknown, weight}; }
  };

  DofMap() = default;
  // Held: fixed nodes, the held axes of the hard nodes of patches by displacement, and nodes that
  // nothing resists. A patch by force has three unknowns, and three more if it turns: its turn
  // about x, y and z times a length of its own (m).
  DofMap(const Lattice& lattice, const TissueModel& model, const ConstrainedState& shape);

  int count() const { return count_; }
  // The unknown that moves the node along the axis without a turn, or kHeld.
  int of(int node, int axis) const { return of_[at(node)][at(axis)]; }
  bool operator==(const DofMap& other) const;

  // How a node's component moves. Patches that turn do so about where they are in the shape.
  Shares sharesOf(const ConstrainedState& shape, int node, int axis) const;
  // The same for a point of the patch (m, tissue frame).
  Shares sharesOf(const ConstrainedState& shape, std::size_t patch, const Vec3& point,
                  int axis) const;
  // The unknown of the patch's turn about an axis, and the turn (rad) over it; kHeld for a patch
  // that does not turn.
  Share turnOf(std::size_t patch, int axis) const;
  Vec3 position(const ConstrainedState& shape, int node) const;  // m

  // Transpose of move(): the generalized forces on the unknowns, of forces on the nodes (N).
  Eigen::VectorXd gather(const ConstrainedState& shape, const std::vector<Vec3>& per_node) const;
  // L2 norm of the forces that held components take.
  double heldNorm(const std::vector<Vec3>& per_node) const;
  void move(ConstrainedState& shape, const Eigen::VectorXd& step, double share) const;

 private:
  struct PatchDofs {
    int first = kHeld;       // of three unknowns: the patch's translation
    int first_turn = kHeld;  // of three: its turn
    double length = 0.0;     // that makes a turn a length (m)
  };

  void bind(const std::vector<LoadingPatch>& patches);
  void number();
  void measure(const ConstrainedState& shape);
  Vec3 turnAbout(const PatchDofs& unknowns, const Eigen::VectorXd& step, double share) const;

  const Lattice* lattice_ = nullptr;
  std::vector<std::array<int, 3>> of_;  // per node and axis: the unknown, or kHeld
  std::vector<int> carrier_;  // per node: the patch by force that it is hard in, -1 = none
  std::vector<PatchDofs> patches_;
  int count_ = 0;
};

}  // namespace robot_tissue
