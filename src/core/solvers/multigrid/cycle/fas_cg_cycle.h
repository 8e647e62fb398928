// One step of nonlinear conjugate gradients with a multigrid cycle as preconditioner (Nocedal and
// Wright 2006, 5.2; Brandt 1977). From the shape x, with forces f:
//
//   s = cycle(x) - x                              the smooth motion, then the smoother
//   beta = (f . s - f' . s) / (f' . s')           Polak and Ribiere; ' of the step before
//   d = s + beta d'                               where cycles alone are slow; d conjugate to more
//                                                 ways in long solves (EarlierWays)
//   x + a d,  f(x + a d) . d about 0              line search, from a = 1 on
//
// Where cycles get on, they stand alone; in contact each is gone on with by one secant,
//
//   x + a s,  a = f(x) . s / (f(x) - f(x + s)) . s,   not farther than four times
#pragma once

#include "solvers/multigrid/cycle/composite_shape.h"
#include "solvers/multigrid/cycle/earlier_ways.h"
#include "solvers/multigrid/cycle/motion_left.h"
#include "solvers/multigrid/cycle/solve_context.h"

namespace robot_tissue {

template <typename Real>
class FasCgCycle {
 public:
  // longest_step: of a node in one cycle, in spacings.
  FasCgCycle(CompositeShape<Real>& shape, double longest_step)
      : shape_(shape), longest_step_(longest_step), direction_(shape.spare()) {}

  // The shape is on other levels: how many steps their smoother takes.
  void reset();
  // Another part of the levels is open: the vectors are of its size from now on.
  void noteOpened();
  int smootherSteps() const { return steps_; }
  int smootherSteps(const SolveContext& solve) const;

  // Forgets the last direction, and what only cycles that go on with it keep.
  void begin();
  // After CoarseCorrection::find.
  void run(const SolveContext& solve, const MotionLeft& left);
  // Steps of the smoother alone, from there on; the last direction is forgotten.
  void smoothFrom(const CompositeVector<Real>& places);

  // Where the last cycle began.
  const CompositeVector<Real>& start() const { return start_; }
  void startHere() { shape_.keepPlaces(start_); }
  bool isConjugate() const { return conjugate_; }  // it went on with the one before

 private:
  using Vector = CompositeVector<Real>;

  void goFurther(int steps);
  bool isSteady(const SolveContext& solve, const MotionLeft& left) const;
  void noteWay(const SolveContext& solve);
  double joinEarlierWays(double own_slope);
  double joinLastDirection(double own_slope);
  bool stepByLineSearch(double slope);
  void stepPlainly();

  CompositeShape<Real>& shape_;
  double longest_step_;
  int steps_ = 3;
  Vector start_;
  Vector force_, force_before_;  // f, f'
  Vector& direction_;            // s, then d
  Vector direction_before_;      // d'
  Vector start_before_;          // of a long solve's cycle, for `ways_`
  EarlierWays<Real> ways_;
  bool keeps_ways_ = false;    // start_before_ is there
  double slope_before_ = 0.0;  // f' . s'
  bool fresh_ = true;          // no direction yet
  bool conjugate_ = false;
};

extern template class FasCgCycle<float>;
extern template class FasCgCycle<double>;

}  // namespace robot_tissue
