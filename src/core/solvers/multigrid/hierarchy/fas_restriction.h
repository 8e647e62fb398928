// What a coarse level starts with in the full approximation scheme (Brandt 1977): the fine level's
// displacement by injection, u_c = R u, and a right-hand side b with which its unbalanced force is
// that of the fine level, restricted:
//
//   f_c(R u) + b = P^T r,   r = the fine level's unbalanced force
//
// so that a fine level in balance asks for no correction. In units of the coarse level: half the
// fine one's number for a displacement, a quarter for a force, an eighth for a moment.
#pragma once

#include <cstddef>
#include <vector>

#include "solvers/multigrid/hierarchy/composite_grid.h"
#include "solvers/multigrid/hierarchy/level_constraints.h"

namespace robot_tissue {

template <typename Real>
class FasRestriction {
 public:
  FasRestriction(CompositeGrid<Real>& grid, const LevelConstraints<Real>& constraints);

  // To be called when the grid's levels are new.
  void reset();
  // From the next finer level; its forces must be those of its displacement.
  void restrictTo(std::size_t coarse);
  // The coarse levels' cells have relief from now on (cell_relief.h), or none, as from the first.
  // Only where all is open.
  void relieve(bool with_relief);
  // Displacement that a coarse level was given last.
  const Field<Real>& start(std::size_t coarse) const { return to_[coarse - 1].start; }

 private:
  struct ToLevel {
    Field<Real> start;
    Field<Real> residual;  // P^T r
    std::vector<GroupVector> residual_of_groups;
  };

  void restrictSprings(std::size_t coarse);

  CompositeGrid<Real>& grid_;
  const LevelConstraints<Real>& constraints_;
  std::vector<ToLevel> to_;  // per coarse level
  bool has_relief_ = false;
};

extern template class FasRestriction<float>;
extern template class FasRestriction<double>;

}  // namespace robot_tissue
