// Between a level and the next coarser one (own): fine nodes move as the trilinear mean of the
// coarse nodes around them, P; forces go the other way by P^T; a coarse node starts where the fine
// node at its place is. In each level's own units: half the displacement, a quarter of the force.
#pragma once

#include "solvers/multigrid/level/cell_operator.h"
#include "solvers/multigrid/level/lattice_coarsening.h"

namespace robot_tissue {

template <typename Real>
class GridTransfer {
 public:
  static constexpr double kTwice = 2.0;  // the coarse level's spacing in the fine one's

  // The fine grid's lowest point stands at the coarse grid's point `at`.
  GridTransfer(const LevelGrid& fine, Coarsening to, const std::array<int, 3>& at = {});

  // The coarse nodes that carry a fine one.
  NodeShares carriersOf(int fine_node) const;

  // To the coarse nodes around the fine grid.
  void restrictForces(const Field<Real>& fine, Field<Real>& coarse) const;
  // Of the coarse nodes in the box.
  void restrictDisplacement(const Field<Real>& fine, const GridBox& box, Field<Real>& coarse) const;
  // The coarse motion, now less start.
  void prolong(const Field<Real>& now, const Field<Real>& start, Field<Real>& fine);
  // Where the coarse nodes have a plane of fine ones, both in the same unit. `between`: room for
  // coarse nodes.
  void prolongPlane(const std::vector<Real>& coarse, int k, std::vector<Real>& between,
                    Real* plane) const;
  // Puts fine nodes where the coarse nodes have them.
  void place(const Field<Real>& coarse, const std::vector<int>& nodes, Field<Real>& fine) const;

 private:
  int coarseRow(int j, int k) const;  // entry at the lowest fine point's x
  int countAlongX() const { return fine_.size[0] / 2 + 1; }

  LevelGrid fine_;
  Coarsening to_;
  std::array<int, 3> at_;
  std::vector<Real> motion_, between_;  // of coarse nodes
};

extern template class GridTransfer<float>;
extern template class GridTransfer<double>;

}  // namespace robot_tissue
