// Whether the forces on the shape have found their answer; beside the estimate of the error, as
// what is rough beside a tool hardly shows in displacements, but in forces. In the units of
// CompositeShape.
#pragma once

#include <vector>

#include "solvers/multigrid/cycle/composite_shape.h"
#include "solvers/multigrid/cycle/solve_context.h"

namespace robot_tissue {

template <typename Real>
class ForceBalance {
 public:
  ForceBalance(const CompositeShape<Real>& shape, double tolerance)
      : shape_(shape), tolerance_(tolerance) {}

  // A solve begins.
  void begin();
  double greatestAtStart() const { return greatest_at_start_; }
  // Of a patch on a node, in the last solve.
  void noteHeld(double greatest) { greatest_held_ = greatest; }

  bool isZero() const;                              // no force at all is left
  bool isReached(const SolveContext& solve) const;  // as well as the displacements ask for
  // So well that the tissue's ends bear the same, to that share of the tolerance; `loaded`: nodes
  // in patches and contacts.
  bool isSettled(const std::vector<int>& loaded, double share) const;

  // Greatest unbalanced force, on nodes and patches by force, over the greatest that there was.
  double residual(const ConstrainedState& state) const;

 private:
  bool isLoaded(const SolveContext& solve) const;
  bool isPushed(const SolveContext& solve) const;
  double greatestGiven() const;
  double greatestActing() const;
  bool isCalm(const SolveContext& solve) const;
  bool isRounding(const SolveContext& solve) const;
  bool areContactsBalanced() const;
  bool arePatchesBalanced() const;
  Vec3 heldForce(const std::vector<int>& loaded) const;

  const CompositeShape<Real>& shape_;
  double tolerance_;
  double greatest_at_start_ = 0.0;    // on a node
  double greatest_on_patches_ = 0.0;  // unbalanced then, on a patch by force
  double greatest_held_ = 0.0;
};

// Sum of what the solve left unbalanced on all that may move (N).
template <typename Real>
Vec3 forceLeftOn(CompositeShape<Real>& shape, double spacing);

extern template class ForceBalance<float>;
extern template class ForceBalance<double>;

}  // namespace robot_tissue
