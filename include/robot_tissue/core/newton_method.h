// The exact equilibrium: Newton's method on the energy, each step by a sparse direct
// factorization, until the unbalanced force is a rounding error. The yardstick for other methods.
//
// Unbalanced force: of all unknowns (Unknowns), L2, over the L2 of what holds the tissue: forces
// on fixed nodes and patches, and gravity.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <chrono>
#include <vector>

#include "robot_tissue/core/energy_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/solver_method.h"
#include "robot_tissue/core/sparse_factor.h"
#include "robot_tissue/core/unknowns.h"

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
  SolveReport solve(const std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) override;
  double patchStep() const override;

 private:
  // Where the search stands.
  struct Balance {
    double potential = 0.0;      // energy less the work of patches by force (J)
    Eigen::VectorXd unbalanced;  // N, per unknown
    double relative = 0.0;       // its norm over what holds the tissue
  };

  void countUnknowns(const std::vector<LoadingPatch>& patches, const LatticeState& state);
  void carryPatches(const std::vector<LoadingPatch>& patches, LatticeState& state);
  SolveStatus iterate(const std::vector<LoadingPatch>& patches, LatticeState& state,
                      int& iterations);
  bool factorize(const LatticeState& state, const std::vector<Vec3>& moved);
  void assemble(const LatticeState& state, const std::vector<Vec3>& moved, bool positive);
  Eigen::VectorXd solveFor(const Eigen::VectorXd& force) const;
  bool search(const std::vector<LoadingPatch>& patches, const Eigen::VectorXd& step,
              LatticeState& state);
  bool improves(const Balance& trial, double promised) const;
  Balance balanceOf(const std::vector<LoadingPatch>& patches, const LatticeState& state) const;
  double potentialOf(const std::vector<LoadingPatch>& patches, const LatticeState& state) const;
  double capped(const Eigen::VectorXd& step) const;
  void describe(const std::vector<LoadingPatch>& patches, const LatticeState& state,
                SolveReport& report);
  double elapsedMs() const;

  const Lattice& lattice_;
  const EnergyModel& model_;
  NewtonOptions options_;
  double stiffness_ = 0.0;  // mean over the nodes at rest (N/m)
  Unknowns unknowns_;
  int springs_cut_ = -1;  // when the pattern was analyzed
  bool analyzed_ = false;
  bool factorized_ = false;             // in this solve
  Eigen::SparseMatrix<double> matrix_;  // second derivative in the unknowns, lower triangle
  double hold_ = 0.0;                   // on the matrix's diagonal (N/m)
  Eigen::VectorXd carried_;             // force that the held nodes' motion puts on the unknowns
  SparseFactor factor_;
  Balance balance_;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace robot_tissue
