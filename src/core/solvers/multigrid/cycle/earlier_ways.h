// The ways that earlier cycles of a solve went, which the next one does not undo: made conjugate to
// all of them (ORTHOMIN, Vinsome 1976; flexible conjugate gradients, Notay 2000),
//
//   d = s - sum over i of (y_i . d) / (y_i . p_i) p_i,   the newest first
//
// p_i: the way, y_i = K p_i: what forces lost along it. The last way is enough where the
// preconditioner is symmetric. A cycle smooths after its coarse motion, not before: it is not, and
// of what hangs by little each cycle undoes some that earlier ones had gained.
#pragma once

#include <deque>

#include "solvers/multigrid/cycle/composite_shape.h"

namespace robot_tissue {

template <typename Real>
class EarlierWays {
 public:
  using Vector = CompositeVector<Real>;

  void clear() { ways_.clear(); }
  bool isEmpty() const { return ways_.empty(); }
  // Where the last cycle began, with what forces; and where it led to.
  struct Place {
    const Vector& shape;
    const Vector& force;
  };
  void add(const Place& from, const Place& to);

  // Makes the direction, in which `force` has the slope, conjugate to the ways. The slope then.
  // Ways of a stiffness that the shape no longer has are forgotten.
  double join(const Vector& force, double slope, Vector& direction);

 private:
  struct Way {
    Vector step;  // p
    Vector loss;  // y
    double work;  // p . y
  };
  std::deque<Way> ways_;  // the newest first
};

extern template class EarlierWays<float>;
extern template class EarlierWays<double>;

}  // namespace robot_tissue
