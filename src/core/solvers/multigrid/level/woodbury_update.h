// What springs that each join several nodes, along one direction, add to the stiffness of the nodes
// alone (own). Node by node they count by their weights' sum, which is many times too stiff for
// whatever leaves their mean in place: so rough motion beside a tool would hardly be smoothed.
// Together, by the formula of Woodbury: with D the nodes' own stiffness, and columns w of the
// springs' weights times their directions,
//
//   (D + W K W^T)^-1 = D^-1 - D^-1 W (K^-1 + W^T D^-1 W)^-1 W^T D^-1
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

  // `inverses`: D^-1 of the nodes.
  void join(std::vector<Spring> springs, const std::vector<Eigen::Matrix3d>& inverses);
  // From D^-1 f to that of all springs.
  void apply(std::vector<Vec3>& motions) const;

 private:
  void findEnvelope();
  void fillMatrix();

  std::vector<Spring> springs_;
  std::vector<std::vector<Vec3>> answers_;    // D^-1 times `along`, per part
  std::vector<std::vector<int>> springs_at_;  // per node
  SkylineCholesky matrix_;                    // K^-1 + W^T D^-1 W
  mutable Eigen::VectorXd forces_;            // of the springs; room that `apply` needs
};

}  // namespace robot_tissue
