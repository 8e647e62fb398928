// The paper's layers and patches, iterated to the equilibrium (own; doc/model.md): smooth motions
// from coarser lattices, rough ones from a smoother on the tissue's own (MultigridSolver).
//
// error_estimate: length (L2) of the motion that the coarse lattices and each node's stiffness say
// is left, over that of the free nodes' displacement.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "loads/dof_constraints.h"
#include "solvers/multigrid/cycle/multigrid_solver.h"
#include "solvers/solver_method.h"

namespace robot_tissue {

class LayeredMethod : public SolverMethod {
 public:
  LayeredMethod(const Lattice& lattice, const ElasticModel& model, const LayeredOptions& options);

  SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) override;
  void beginStep(const LatticeState& state) override;
  void expect(const LatticeState& state) override { solver_->expect(state); }
  void limitWays(std::vector<WayLimit>&& limits) override { limits_ = std::move(limits); }
  void forget() override;
  bool remembers() const override { return true; }
  const GridBox* visited() const override { return solver_->visited(); }
  Vec3 forceLeft() override { return solver_->forceLeft(); }
  bool staysFinite() const override { return true; }
  bool findsEquilibrium() const override { return true; }
  bool dampsStrain() const override { return true; }
  void limitTime(double ms) override { options_.max_ms = ms; }
  void limitIterations(int most) override { most_cycles_ = most; }
  double patchStep() const override;
  int usualIterations() const override;

 private:
  Precision precisionIn(const LatticeState& state) const;
  void use(Precision precision);

  const Lattice& lattice_;
  const ElasticModel& model_;
  LayeredOptions options_;
  int most_cycles_ = std::numeric_limits<int>::max();
  DofConstraints hold_;
  std::vector<WayLimit> limits_;
  Precision precision_;
  std::unique_ptr<MultigridSolver> solver_;
  std::unique_ptr<MultigridSolver> other_;  // in the other precision; null: was not used yet
};

}  // namespace robot_tissue
