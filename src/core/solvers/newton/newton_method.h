// The exact equilibrium: Newton's method on the energy, each step by a sparse direct
// factorization, until the unbalanced force is a rounding error. The yardstick for other methods.
//
// Unbalanced force: of all unknowns (DofMap), L2, over the L2 of what holds the tissue: forces
// on fixed nodes and patches.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <limits>
#include <memory>
#include <vector>

#include "material/energy_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/solve_report.h"
#include "solvers/newton/dof_map.h"
#include "solvers/newton/equilibrium.h"
#include "solvers/newton/sparse_factor.h"
#include "solvers/solve_clock.h"
#include "solvers/solver_method.h"

namespace robot_tissue {

struct NewtonOptions {
  double residual = 1e-10;  // converged when the unbalanced force is below
  int max_iterations = 100;
  // Longest motion of a patch in one solve, and of a node in one iteration, in spacings.
  double patch_step = 0.5;
  double node_step = 2.0;
  double max_ms = 0.0;  // 0 = no budget
};

class NewtonMethod : public SolverMethod {
 public:
  NewtonMethod(const Lattice& lattice, const EnergyModel& model, const NewtonOptions& options);

  // `disturbed` is not needed: all free nodes are solved for.
  SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) override;
  bool findsEquilibrium() const override { return true; }
  bool dampsStrain() const override { return true; }
  void limitTime(double ms) override { options_.max_ms = ms; }
  void limitIterations(int most) override { most_iterations_ = most; }
  double patchStep() const override;
  int usualIterations() const override;

 private:
  void countUnknowns(const ConstrainedState& shape);
  void carryPatches(ConstrainedState& shape);
  SolveStatus iterate(ConstrainedState& shape, int& iterations);
  bool factorize(const ConstrainedState& shape, const std::vector<Vec3>& moved);
  void diagonalShift(double stiffness);
  Eigen::VectorXd solveFor(const Eigen::VectorXd& force) const;
  bool search(const Eigen::VectorXd& step, ConstrainedState& shape);
  void takeBalance(const Balance& balance);
  bool improves(const Balance& trial, double promised) const;
  double capped(const ConstrainedState& shape, const Eigen::VectorXd& step) const;
  void describe(const ConstrainedState& shape, SolveReport& report);

  const Lattice& lattice_;
  const EnergyModel& model_;
  NewtonOptions options_;
  int most_iterations_ = std::numeric_limits<int>::max();
  double stiffness_ = 0.0;  // mean over the nodes at rest (N/m)
  double hold_ = 0.0;       // likewise, of cells alone
  DofMap unknowns_;
  std::vector<int> rims_;  // nodes of rims and contacts at the matrix's last analysis
  std::shared_ptr<const CellSet> cells_;  // likewise
  bool analyzed_ = false;
  bool factorized_ = false;             // in this solve
  Eigen::SparseMatrix<double> matrix_;  // second derivative in the unknowns, lower triangle
  double diagonal_shift_ = 0.0;         // on the matrix's diagonal (N/m)
  Eigen::VectorXd carried_;             // force that the held nodes' motion puts on the unknowns
  std::unique_ptr<SparseFactor> factor_ = makeSparseFactor();
  Balance balance_;
  double relative_ = 0.0;  // the unbalanced force over what holds the tissue
  SolveClock clock_;
};

}  // namespace robot_tissue
