// How the shape is found. In: the loading patches (those by force are moved to where they balance),
// and nodes whose balance something else has disturbed (a cut, gravity, a patch they left). In and
// out: the shape, its last value being the start. Out: what the solver says of itself.
#pragma once

#include <vector>

#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/solve_report.h"

namespace robot_tissue {

class SolverMethod {
 public:
  virtual ~SolverMethod() = default;

  virtual SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                            LatticeState& state) = 0;

  // The solves that follow, up to the next call, are of one load step.
  virtual void beginStep(const LatticeState&) {}

  // How far each node may go in the solves that follow (m); empty: as far as it balances. A solve
  // in which one went farther may end there, unconverged.
  virtual void limitWays(std::vector<double>) {}

  // Time that each solve may take from here on (ms), in the place of the options' max_ms; 0: no
  // bound.
  virtual void limitTime(double) {}

  // Drops what earlier solves taught it: the next answer hangs on its arguments alone.
  virtual void forget() {}
  // Whether there is anything to be dropped.
  virtual bool remembers() const { return false; }

  // Grid points among which the last solve moved nodes one by one, of lattices of which it moves
  // the others as a lattice of a greater spacing has them; null where it moves all one by one.
  virtual const GridBox* visited() const { return nullptr; }
  // Sum of the forces that the last solve left unbalanced on all that may move (N), where it did
  // not visit all nodes: those of the others, one by one, do not tell it.
  virtual Vec3 forceLeft() { return Vec3::Zero(); }

  // Whether a solve leaves the shape and the patches as they were rather than put numbers into them
  // that are not finite.
  virtual bool staysFinite() const { return false; }

  // Whether it finds the equilibrium of an energy: then patches may turn and have springs, at their
  // rims and in contact; if not, all their nodes are hard.
  virtual bool findsEquilibrium() const { return false; }

  // Longest motion of a patch in one solve that the method follows well (m).
  virtual double patchStep() const = 0;
};

}  // namespace robot_tissue
