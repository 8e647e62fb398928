// The unknowns of an equilibrium: which components of which nodes are free to move, and which move
// as one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/tissue_model.h"

namespace robot_tissue {

class Unknowns {
 public:
  static constexpr int kHeld = -1;

  Unknowns() = default;
  // Held: fixed nodes, the held axes of patches by displacement, and nodes that nothing resists.
  // The nodes of a patch by force share three unknowns.
  Unknowns(const Lattice& lattice, const TissueModel& model,
           const std::vector<LoadingPatch>& patches, const LatticeState& state);

  int count() const { return count_; }
  // The unknown that moves the node along the axis, or kHeld.
  int of(int node, int axis) const { return of_[at(node)][at(axis)]; }
  bool operator==(const Unknowns& other) const { return of_ == other.of_; }

  // Sum over the nodes of each unknown.
  Eigen::VectorXd gather(const std::vector<Vec3>& per_node) const;
  // L2 norm of what gather() leaves out.
  double heldNorm(const std::vector<Vec3>& per_node) const;
  void addTo(std::vector<Vec3>& per_node, const Eigen::VectorXd& step, double share) const;

 private:
  std::vector<std::array<int, 3>> of_;
  int count_ = 0;
};

}  // namespace robot_tissue
