// Between a level and the next coarser one (doc/architecture.md, "Words"): prolongation P, by which
// a fine node moves as the trilinear mean of the coarse nodes around it; restriction of forces by
// P^T; injection of displacements, a coarse node starts where the fine node at its place is. In
// each level's own units: lengths in h or 2 h, forces in E0 h^2 or E0 (2 h)^2.
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

  // In these threads from now on, where the fine grid is worth it.
  void share(Workers& workers) { workers_ = &workers; }

  // The coarse nodes that carry a fine one.
  NodeShares carriersOf(int fine_node) const;

  // coarse = P^T fine / 4, at all coarse nodes that carry fine ones.
  void restrictForces(const Field<Real>& fine, Field<Real>& coarse) const;
  // coarse = fine / 2 at the same place, for coarse nodes in the box.
  void restrictDisplacement(const Field<Real>& fine, const GridBox& box, Field<Real>& coarse) const;
  // fine = 2 P (now - start).
  void prolong(const Field<Real>& now, const Field<Real>& start, Field<Real>& fine);
  // P on a plane of fine nodes, with coarse and fine values in the same unit. `between`: scratch.
  void prolongPlane(const Numbers<Real>& coarse, int k, Numbers<Real>& between, Real* plane) const;
  // fine = 2 P coarse at these fine nodes.
  void place(const Field<Real>& coarse, const std::vector<int>& nodes, Field<Real>& fine) const;

 private:
  // Calls visit(first, end) for planes, of so many, each in a thread.
  template <typename Visit>
  void forPlanes(int planes, Visit visit) const;
  std::array<int, 3> placeOnCoarse(int fine_node) const;
  void restrictPlanes(const Numbers<Real>& fine, int first, int end, Numbers<Real>& coarse) const;
  int coarseRow(int j, int k) const;  // entry at the lowest fine point's x
  int countAlongX() const { return fine_.size[0] / 2 + 1; }

  LevelGrid fine_;
  Coarsening to_;
  std::array<int, 3> at_;
  Numbers<Real> motion_;  // of coarse nodes
  Workers* workers_ = nullptr;
};

extern template class GridTransfer<float>;
extern template class GridTransfer<double>;

}  // namespace robot_tissue
