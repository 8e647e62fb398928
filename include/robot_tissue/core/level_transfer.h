// Between a level and the next coarser one (own): fine nodes move as the trilinear mean of the
// coarse nodes around them, P; forces go the other way by P^T; a coarse node starts where the fine
// node at its place is. In each level's own units: half the displacement, a quarter of the force.
#pragma once

#include "robot_tissue/core/lattice_coarsening.h"
#include "robot_tissue/core/level_cells.h"

namespace robot_tissue {

template <typename Real>
class LevelTransfer {
 public:
  static constexpr double kTwice = 2.0;  // the coarse level's spacing in the fine one's

  LevelTransfer(const LevelGrid& fine, Coarsening to);

  // The coarse nodes that carry a fine one.
  NodeShares carriersOf(int fine_node) const;

  // In the rows of the coarse box, and next to it.
  void restrictForces(const Field<Real>& fine, const LevelBox& box, Field<Real>& coarse) const;
  void restrictDisplacement(const Field<Real>& fine, const LevelBox& box,
                            Field<Real>& coarse) const;
  // The coarse motion, now less start, in the rows of the fine box.
  void prolong(const Field<Real>& now, const Field<Real>& start, const LevelBox& box,
               Field<Real>& fine) const;

 private:
  LevelGrid fine_;
  Coarsening to_;
};

extern template class LevelTransfer<float>;
extern template class LevelTransfer<double>;

}  // namespace robot_tissue
