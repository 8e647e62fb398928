// Nodes' stiffness together with that of springs which each join several nodes along one direction.
// Counted node by node (l1-Jacobi), such a spring is many times too stiff for motions that leave
// the mean of its nodes in place: rough motion beside a tool would hardly be smoothed. By the
// formula of Woodbury (1950), with D the nodes' own stiffness, K the springs' (diagonal), and a
// column of W per spring, its weights times its direction,
//
//   (D + W K W^T)^-1 = D^-1 - D^-1 W (K^-1 + W^T D^-1 W)^-1 W^T D^-1
//
// Where many springs share few nodes, as those of a fine tool on a coarse lattice do, a matrix of
// their nodes is smaller than that of the springs. With D^-1 = L L^T, node by node, and B = L^T W,
//
//   (D + W K W^T)^-1 = D^-1 - L (I + B K B^T)^-1 B K W^T D^-1
//
// The one whose envelope takes less work is factorized.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot_tissue/core/types.h"
#include "solvers/multigrid/level/skyline_cholesky.h"

namespace robot_tissue {

class WoodburyUpdate {
 public:
  struct Part {
    int node = 0;               // entry of `motions`
    Vec3 along = Vec3::Zero();  // direction times weight
  };
  struct Spring {
    std::vector<Part> parts;
    double stiffness = 0.0;
  };

  // `inverses`: D^-1 of the nodes, per node (one over E0 h).
  void join(std::vector<Spring> springs, const std::vector<Eigen::Matrix3d>& inverses);
  // In place, from D^-1 f to (D + W K W^T)^-1 f.
  void apply(std::vector<Vec3>& motions) const;
  // forces += W K W^T motions.
  void addForces(const std::vector<Vec3>& motions, std::vector<Vec3>& forces) const;

 private:
  std::vector<int> envelopeOfSprings() const;
  std::vector<int> envelopeOfNodes();
  void fillForSprings(const std::vector<Eigen::Matrix3d>& inverses);
  void fillForNodes(const std::vector<Eigen::Matrix3d>& inverses);
  double lengthening(const Spring& spring, const std::vector<Vec3>& motions) const;
  void applyBySprings(std::vector<Vec3>& motions) const;
  void applyByNodes(std::vector<Vec3>& motions) const;

  std::vector<Spring> springs_;
  std::vector<std::vector<int>> springs_at_;  // per node
  std::vector<int> joined_;                   // nodes with springs
  std::vector<int> row_of_;                   // per node: its first row, where nodes are solved for
  bool by_nodes_ = false;
  std::vector<std::vector<Vec3>> columns_;  // D^-1 W; by nodes B: per spring and part
  std::vector<Eigen::Matrix3d> roots_;      // L, per joined node
  SkylineCholesky matrix_;                  // K^-1 + W^T D^-1 W; by nodes I + B K B^T
  mutable Eigen::VectorXd unknowns_;        // room that `apply` needs
};

}  // namespace robot_tissue
