// Cycles until the shape of the open part balances, or does not get on, or the budget is spent.
#pragma once

#include "solvers/multigrid/cycle/error_estimator.h"
#include "solvers/multigrid/cycle/fas_cg_cycle.h"
#include "solvers/multigrid/cycle/force_balance.h"
#include "solvers/multigrid/cycle/multigrid_solver.h"
#include "solvers/multigrid/cycle/open_part.h"
#include "solvers/multigrid/cycle/solve_progress.h"
#include "solvers/multigrid/cycle/way_limits.h"

namespace robot_tissue {

template <typename Real>
class FasCgIteration {
 public:
  // As ErrorEstimator.
  void measureFrom(const CompositeVector<Real>* free_motion, double least) {
    estimator_.measureFrom(free_motion, least);
  }
  // What it reads and moves must outlive it.
  struct On {
    CompositeShape<Real>& shape;
    const OpenPart& part;
    const WayLimits& limits;
    const ForceBalance<Real>& forces;
  };
  FasCgIteration(const On& on, const LayeredOptions& options);

  // The shape is on the levels of other cells. On trial: what a trial at rest shows of them is the
  // least error factor; else the earlier one stays.
  void reset() {
    cycle_.reset();
    estimator_.factor.forget();
  }
  // `known`: as ErrorFactor::restart.
  void resetOnTrial(const Lattice& lattice, const ElasticModel& model, const LatticeState& state,
                    double known);
  double errorFactor() const { return estimator_.factor.value(); }
  // The shape is on the same levels, of which another part is open.
  void noteOpened() {
    cycle_.noteOpened();
    estimator_.noteOpened();
  }
  void forget() {
    estimator_.factor.forget();
    is_bent_ = false;
  }

  SolveStatus run(SolveContext& solve);
  double error() const { return estimator_.error(); }  // of the shape that the last run left
  bool wentTooFar() const;                             // likewise: beyond the limits of ways

 private:
  SolveStatus check(const SolveContext& solve);
  bool isBent(const SolveContext& solve) const;
  bool areMembranesStiff(const SolveContext& solve) const;
  bool isBalanced(const SolveContext& solve) const;
  bool isEasy(const SolveContext& solve) const;
  bool isQuiet(double rough_before) const;
  bool isRounded(const SolveContext& solve) const;
  bool isHopeless(const SolveContext& solve) const;
  void makeCycle(const SolveContext& solve);
  void finish(const SolveContext& solve);
  void finishLate(const SolveContext& solve);
  void settleForces(const SolveContext& solve);

  CompositeShape<Real>& shape_;
  const OpenPart& part_;
  const WayLimits& limits_;
  const ForceBalance<Real>& forces_;
  LayeredOptions options_;
  FasCgCycle<Real> cycle_;
  ErrorEstimator<Real> estimator_;
  SolveProgress<Real> progress_;
  bool is_bent_ = false;  // coarse cells need relief
};

extern template class FasCgIteration<float>;
extern template class FasCgIteration<double>;

}  // namespace robot_tissue
