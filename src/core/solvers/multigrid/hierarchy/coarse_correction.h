// The smooth motion that the coarse levels find for the finest one: a V-cycle of the full
// approximation scheme (Brandt 1977), from the finest level's forces on,
//
//   s = P (u_c - R u),   u_c = the coarse level's displacement when it has been solved for
//
// with a few steps of the smoother for a solution, before and after its own correction.
#pragma once

#include <cstddef>
#include <vector>

#include "solvers/multigrid/hierarchy/composite_grid.h"
#include "solvers/multigrid/hierarchy/fas_restriction.h"
#include "solvers/multigrid/hierarchy/uncovered_part.h"

namespace robot_tissue {

template <typename Real>
class CoarseCorrection {
 public:
  CoarseCorrection(CompositeGrid<Real>& grid, FasRestriction<Real>& restriction,
                   UncoveredPart<Real>& uncovered);

  // To be called when the grid's levels are new: no motion.
  void reset();
  // The motion that goes with the finest level's forces; zero where it is not finite.
  void find();
  void moveBy(double alpha);  // the shape += alpha * motion

  // As found last, in spacings of the finest lattice; zero where no node is.
  const Field<Real>& motion() const { return motions_.front(); }  // of the finest level
  const std::vector<GroupVector>& groupMotion() const { return group_motion_; }
  double squaredUncovered() const;  // of the uncovered part

 private:
  void solve(std::size_t level);
  void correct(std::size_t fine);
  bool isTurned(std::size_t level) const;
  std::vector<GroupVector> prolongedGroupMotion(std::size_t coarse) const;
  void takeUncoveredMotion();
  bool isFinite() const;
  void giveUp();

  CompositeGrid<Real>& grid_;
  FasRestriction<Real>& restriction_;
  UncoveredPart<Real>& uncovered_;
  std::vector<Field<Real>> motions_;  // per level: P (u_c - R u)
  std::vector<int> missing_;          // entries of the finest level that are no nodes
  std::vector<GroupVector> group_motion_;
  typename UncoveredPart<Real>::Vector uncovered_motion_;
};

extern template class CoarseCorrection<float>;
extern template class CoarseCorrection<double>;

}  // namespace robot_tissue
