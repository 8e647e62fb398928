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
  // One after the other in common memory, which stays when they are others.
  class Springs {
   public:
    void clear();
    void add(double stiffness, std::size_t parts);  // room for its parts, which are to be set
    std::size_t size() const { return stiffness_.size(); }
    double stiffness(std::size_t spring) const { return stiffness_[spring]; }
    // Numbers of its parts, from first(spring) on and before first(spring + 1).
    std::size_t first(std::size_t spring) const { return first_[spring]; }
    const Part& part(std::size_t number) const { return parts_[number]; }
    Part& partOfLast(std::size_t i) { return parts_[first_[size() - 1] + i]; }
    std::size_t partCount() const { return parts_.size(); }
    int leastNode(std::size_t spring) const;

   private:
    std::vector<Part> parts_;
    std::vector<std::size_t> first_ = {0};  // and the end
    std::vector<double> stiffness_;
  };

  // `inverses`: D^-1 of the nodes, per node (one over E0 h).
  void join(const Springs& springs, const std::vector<Eigen::Matrix3d>& inverses);
  // In place, from D^-1 f to (D + W K W^T)^-1 f.
  void apply(std::vector<Vec3>& motions) const;
  // forces += W K W^T motions.
  void addForces(const std::vector<Vec3>& motions, std::vector<Vec3>& forces) const;

 private:
  void sortByNodes(const Springs& springs);
  void findSpringsOfNodes(std::size_t nodes);
  std::vector<int> envelopeOfSprings() const;
  std::vector<int> envelopeOfNodes();
  void fillForSprings(const std::vector<Eigen::Matrix3d>& inverses);
  void fillForNodes(const std::vector<Eigen::Matrix3d>& inverses);
  double lengthening(std::size_t spring, const std::vector<Vec3>& motions) const;
  void applyBySprings(std::vector<Vec3>& motions) const;
  void applyByNodes(std::vector<Vec3>& motions) const;

  // A spring at a node, and which of its parts is.
  struct Joint {
    int spring = 0;
    std::size_t part = 0;
  };

  Springs springs_;                       // by their least node
  std::vector<std::size_t> first_joint_;  // per node: of its joints, in the springs' order; the end
  std::vector<Joint> joints_;
  std::vector<int> joined_;  // nodes with springs
  std::vector<int> row_of_;  // per node: its first row, where nodes are solved for
  bool by_nodes_ = false;
  std::vector<Vec3> columns_;           // D^-1 W; by nodes B: per part
  std::vector<Eigen::Matrix3d> roots_;  // L, per joined node
  SkylineCholesky matrix_;              // K^-1 + W^T D^-1 W; by nodes I + B K B^T
  mutable Eigen::VectorXd unknowns_;    // room that `apply` needs
};

}  // namespace robot_tissue
