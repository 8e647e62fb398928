// How far the shape is from balance, relative to its displacement:
//
//   error = factor |x| / max(|u|, least)
//
// |x| is the length of the motion left that cycles see (CompositeShape::correctionNorm); the factor
// makes up for what they do not see, |u| is the length of the displacement. In a time step it is
// the length of the way from where the nodes would go without a force: what forces do in that time.
#pragma once

#include <algorithm>

#include "solvers/multigrid/cycle/composite_shape.h"
#include "solvers/multigrid/cycle/fas_cg_cycle.h"
#include "solvers/multigrid/cycle/motion_left.h"
#include "solvers/multigrid/cycle/solve_context.h"

namespace robot_tissue {

// What is really left over what cycles see, learned from solve to solve.
class ErrorFactor {
 public:
  // Of a lattice whose least factor a trial at rest showed. `known`: from solves of another part of
  // it, 1 where there were none.
  void restart(double least, double known) {
    least_ = least;
    value_ = std::max(least, known);
  }
  void forget() { value_ = least_; }
  double value() const { return value_; }
  // From what a solve showed in its first cycles (kLong of them), or later.
  enum class Solve { kShort, kLong };
  void learn(double shown, Solve solve);

 private:
  double least_ = 1.0;
  double value_ = 1.0;
};

template <typename Real>
class ErrorEstimator {
 public:
  explicit ErrorEstimator(const CompositeShape<Real>& shape) : shape_(shape) {}

  ErrorFactor factor;

  // The motion without a force, that errors are relative to the way from, or to `least` (spacings);
  // null: no time step. It must live as long as the cycles.
  void measureFrom(const CompositeVector<Real>* free_motion, double least) {
    free_motion_ = free_motion;
    least_way_ = least;
  }

  // Cycles begin, from the shape as it is.
  void begin();
  // Another part is open: earlier shapes are of other nodes, and distances from them are not known.
  void noteOpened() { knows_way_ = false; }
  // After CoarseCorrection::find; the last cycle is that one, if there was one.
  void update(const SolveContext& solve, const FasCgCycle<Real>& last);

  const MotionLeft& left() const { return left_; }
  double distanceFromStart() const { return shape_.distanceFrom(start_); }
  double error() const { return error_; }
  double errorAfterCorrection() const { return error_after_; }

  // The correction has been made.
  void noteCorrection() { error_ = error_after_; }
  // Another shape, with that error, was put in place.
  void noteError(double error) { error_ = error; }
  // No force acts at all.
  void noteRest() { error_ = error_after_ = left_.now = 0.0; }

 private:
  void learn(const SolveContext& solve, const FasCgCycle<Real>& last, double trend_before);
  void mark(int cycles);

  const CompositeShape<Real>& shape_;
  const CompositeVector<Real>* free_motion_ = nullptr;
  double least_way_ = 0.0;
  MotionLeft left_;
  double trend_ = 0.0;  // |x|, as it falls under conjugate gradients, where it swings
  double error_ = 0.0;
  double error_after_ = 0.0;  // once the smooth motion that is found has been made
  CompositeVector<Real> start_;
  bool at_start_ = true;
  bool knows_way_ = false;  // of the last cycle, in the part that is open

  // A shape of this solve, at half of its cycles or before.
  CompositeVector<Real> mark_;
  int mark_cycle_ = 0;
  double mark_left_ = 0.0;  // |x| there; 0: no mark
};

extern template class ErrorEstimator<float>;
extern template class ErrorEstimator<double>;

}  // namespace robot_tissue
