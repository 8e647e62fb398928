// How method `layered` comes to balance, in the precision of Real
// (core/solvers/multigrid/cycle/multigrid_solver.h). Who does what:
//
//   FasCgSolver      what is given becomes a shape on the levels, the answer is written back
//   OpenPart         which part of the lattice is solved for
//   WarmStart        the first guess
//   FasCgIteration   cycles until it balances, or there is no hope
//   FasCgCycle       one of them: multigrid as preconditioner of conjugate gradients
//   ErrorEstimator   how far it is, in displacements; SolveProgress: what was gained
//   ForceBalance     how far it is, in forces
//   CompositeShape   the shape and its forces on all levels, as one vector
//   SolveContext     what goes from one to the other in a solve
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "solvers/multigrid/cycle/fas_cg_iteration.h"
#include "solvers/multigrid/cycle/multigrid_solver.h"
#include "solvers/multigrid/cycle/warm_start.h"
#include "solvers/multigrid/hierarchy/free_ends.h"

namespace robot_tissue {

template <typename Real>
class FasCgSolver : public MultigridSolver {
 public:
  FasCgSolver(const Lattice& lattice, const ElasticModel& model, const LayeredOptions& options);

  SolveReport run(ConstrainedState& shape, const DofConstraints& hold,
                  const std::vector<int>& disturbed, const Budget& budget) override;
  void limitWays(std::vector<WayLimit> limits) override { limits_.set(std::move(limits)); }
  void beginStep() override { warm_start_.beginStep(); }
  Vec3 forceLeft() override;
  bool wantsDouble() const override { return wants_double_; }
  const GridBox* visited() const override;
  void forget() override;
  void expect(const LatticeState& state) override;

 private:
  void takeTimeStep(const SolveContext& solve);
  void findLevels(const LatticeState& state, const Budget& budget);
  void measureLevels(const LatticeState& state, double known_factor, bool is_longer);
  void open(const SolveContext& solve, const GridBox& box);
  void prepare(const SolveContext& solve);
  SolveStatus balance(SolveContext& solve);
  void writeShape(SolveContext& solve) const;
  double settlePatches(SolveContext& solve);
  void forgetLevels();
  SolveReport giveUp(const SolveContext& solve);
  bool isForDouble(const SolveContext& solve, SolveStatus status) const;
  void answer(const SolveContext& solve, SolveReport& report);

  const Lattice& lattice_;
  const ElasticModel& model_;
  double tolerance_;
  std::unique_ptr<Workers> workers_;
  std::shared_ptr<const CellSet> cells_;     // that the levels were made of
  std::shared_ptr<const CellSet> measured_;  // that the stiffness and error factor are of
  bool is_measure_due_ = false;              // too many cells are others since
  bool begins_anew_ = false;                 // nothing was solved for since forget()
  double measuring_ms_ = 0.0;                // what it takes
  CompositeShape<Real> shape_;
  OpenPart part_;
  FreeEnds ends_;
  WayLimits limits_;
  ForceBalance<Real> forces_;
  WarmStart<Real> warm_start_;
  FasCgIteration<Real> iteration_;
  CompositeVector<Real> free_motion_;  // in a time step
  bool wants_double_ = false;
  bool knows_cells_ = false;  // the finest level's cells have the forces of its displacement
};

extern template class FasCgSolver<float>;
extern template class FasCgSolver<double>;

}  // namespace robot_tissue
