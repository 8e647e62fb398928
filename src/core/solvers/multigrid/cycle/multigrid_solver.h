// How method `layered` comes to balance, in single or double precision (own; doc/model.md).
//
// One cycle: a smooth motion of all layers, found on coarser levels (GridHierarchy); then a few
// steps of a smoother on the tissue's own. Where cycles gain little they are strung together by
// conjugate gradients; where one goes too far or not far enough, a search along it mends that.
#pragma once

#include <memory>
#include <vector>

#include "loads/dof_constraints.h"
#include "material/elastic_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/solve_report.h"
#include "solvers/multigrid/cycle/budget.h"
#include "solvers/solver_method.h"

namespace robot_tissue {

struct LayeredOptions {
  double tolerance = 0.01;  // of error_estimate
  double max_ms = 0.0;      // 0 = no budget; the cycle under way is finished, at least one is made
  int threads = 1;          // the result is the same with any number
  int max_cycles = 2000;
  int patience = 1000;  // cycles that led neither to a better shape nor farther
  // Likewise where contacts are: what goes far there slips, and a smaller step follows it better.
  int max_cycles_in_contact = 300;
  int patience_in_contact = 40;
  double patch_step = 0.5;  // longest motion of a patch in one solve, in spacings
  double line_step = 2.0;   // of a node in one cycle, likewise
};

class MultigridSolver {
 public:
  virtual ~MultigridSolver() = default;

  // Moves the shape to where it balances; `hold` is bound to it. Fills status, iterations,
  // error_estimate, residual, active_nodes and the patches' answers.
  // `disturbed`: nodes whose balance something else has disturbed.
  virtual SolveReport run(ConstrainedState& shape, const DofConstraints& hold,
                          const std::vector<int>& disturbed, const Budget& budget) = 0;
  // The last solve stopped at what single precision can tell, and the shape is as it was before: it
  // is to be solved for in double.
  virtual bool wantsDouble() const = 0;
  virtual void limitWays(std::vector<WayLimit> limits) = 0;  // as SolverMethod
  virtual void beginStep() = 0;
  virtual void expect(const LatticeState& state) = 0;  // as SolverMethod
  virtual const GridBox* visited() const = 0;          // as SolverMethod
  virtual Vec3 forceLeft() = 0;                        // likewise (N)
  virtual void forget() = 0;
};

enum class Precision { kSingle, kDouble };

// Double where single does not reach the tolerance, wherever the tissue goes.
Precision precisionFor(const ElasticModel& model, const LayeredOptions& options);
std::unique_ptr<MultigridSolver> makeMultigridSolver(const Lattice& lattice,
                                                     const ElasticModel& model,
                                                     const LayeredOptions& options,
                                                     Precision precision);

}  // namespace robot_tissue
