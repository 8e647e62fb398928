// How far nodes may go in one solve.
#pragma once

#include <utility>
#include <vector>

#include "solvers/multigrid/cycle/multigrid_solver.h"

namespace robot_tissue {

class NodeLimits {
 public:
  void set(std::vector<MultigridSolver::NodeLimit> limits) { limits_ = std::move(limits); }
  // A solve begins there (m).
  void begin(const std::vector<Vec3>& displacement) {
    from_.clear();
    for (const auto& limit : limits_) from_.push_back(displacement[at(limit.node)]);
  }
  // displacementOf(node) is where a node is now (m).
  template <typename DisplacementOf>
  bool areExceeded(DisplacementOf displacementOf) const {
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      const Vec3 step = displacementOf(limits_[i].node) - from_[i];
      if (step.norm() > limits_[i].longest) return true;
    }
    return false;
  }

 private:
  std::vector<MultigridSolver::NodeLimit> limits_;
  std::vector<Vec3> from_;
};

}  // namespace robot_tissue
