// The open nodes of coarse levels that no finer level covers: with the finest level's, they are all
// nodes that the composite grid is solved for. Where the finest level is open as a whole there are
// none, and every vector here is empty.
//
// A node of level l stands for 2^(3 l) = 8^l of the finest lattice; its lengths are in 2^l h, its
// forces in 4^l E0 h^2.
#pragma once

#include <cstddef>
#include <vector>

#include "solvers/multigrid/hierarchy/composite_grid.h"
#include "solvers/multigrid/hierarchy/fas_restriction.h"

namespace robot_tissue {

template <typename Real>
class UncoveredPart {
 public:
  // By levels from the first coarse one on, in each one's units; covered nodes' values are zero or
  // left alone.
  using Vector = std::vector<Field<Real>>;

  UncoveredPart(CompositeGrid<Real>& grid, FasRestriction<Real>& restriction)
      : grid_(grid), restriction_(restriction) {}

  Vector places() const;
  void placeAt(const Vector& places);
  void moveBy(const Vector& step, double alpha);  // u += alpha * step
  // Unbalanced, with the finest level's forces as they are.
  Vector findForces();
  // In E0 h^3: sum over levels of 8^l times the products in the level's units.
  static double workOf(const Vector& force, const Vector& step);

  // Squared and summed over the finest lattice's nodes, in its spacings.
  double squared(const Vector& motion) const;
  double squaredDistanceFrom(const Vector& places) const;
  double squaredDisplacement() const;
  double squaredRoughness() const;  // what trilinear means miss of the displacement

 private:
  template <typename Visit>
  void forRows(std::size_t level, Visit visit) const;
  double squaredOn(std::size_t level, const Field<Real>& of, const Field<Real>* less) const;
  double squaredDifferences(std::size_t level) const;

  CompositeGrid<Real>& grid_;
  FasRestriction<Real>& restriction_;
};

extern template class UncoveredPart<float>;
extern template class UncoveredPart<double>;

}  // namespace robot_tissue
