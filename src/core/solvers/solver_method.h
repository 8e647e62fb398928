// How the shape is found. In: the loading patches (those by force are moved to where they balance),
// and nodes whose balance something else has disturbed (a cut, gravity, a patch they left). In and
// out: the shape, its last value being the start. Out: what the solver says of itself.
#pragma once

#include <limits>
#include <vector>

#include "robot_tissue/core/carriers.h"
#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/solve_report.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// How far a point that nodes carry may go in a solve (m), as sum of weight * displacement of node.
struct WayLimit {
  CarrierRange carriers;
  double longest = 0.0;
};

class SolverMethod {
 public:
  virtual ~SolverMethod() = default;

  virtual SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                            LatticeState& state) = 0;

  // There will be solves of this state's cells: what the first one makes may be made now. Their
  // answers are the same.
  virtual void expect(const LatticeState&) {}

  // The solves that follow, up to the next call, are of one load step.
  virtual void beginStep(const LatticeState&) {}

  // Of the solves up to the next call, which their carriers must outlive. A solve in which a point
  // went farther than it may can end there, unconverged.
  virtual void limitWays(std::vector<WayLimit>&&) {}

  // Time that each solve may take from here on (ms), in the place of the options' max_ms; 0: no
  // bound.
  virtual void limitTime(double) {}
  // Likewise iterations, besides the options' own bound; then it ends, unconverged. To be kept by
  // methods that know their usual iterations.
  virtual void limitIterations(int) {}

  // Whether it has what damps the strain of a time step (InertialTerm::dampsStrain); else the rate
  // of all forces damps.
  virtual bool dampsStrain() const { return false; }

  // Whether it goes through a time step in steps of its own: contacts go along their plane_way, and
  // are left with the force that they had in the mean.
  virtual bool goesThroughTimeSteps() const { return false; }

  // Of the nodes at the end of the last time step (m/s), where the method goes through it in steps
  // of its own; null: they follow from the shape.
  virtual const std::vector<Vec3>* velocities() const { return nullptr; }

  // Drops what it has learned from earlier solves: the next answer depends on its arguments alone.
  virtual void forget() {}
  // Whether there is anything to be dropped.
  virtual bool remembers() const { return false; }

  // The grid points among which the last solve moved each node of the lattice by itself. The nodes
  // beyond them it put where a lattice of a greater spacing has them. Null: it moved all by
  // themselves.
  virtual const GridBox* visited() const { return nullptr; }
  // Where visited() is not null: sum of the forces that the last solve left unbalanced on all that
  // may move (N). Beyond those points forces balance as the greater lattice has them, not node by
  // node, so that a sum over the nodes does not tell it.
  virtual Vec3 forceLeft() { return Vec3::Zero(); }

  // Whether a solve leaves the shape and the patches as they were rather than put numbers into them
  // that are not finite.
  virtual bool staysFinite() const { return false; }

  // Whether it finds the equilibrium of an energy: then patches may turn and have springs, at their
  // rims and in contact; if not, all their nodes are hard.
  virtual bool findsEquilibrium() const { return false; }

  // Iterations of one load step beyond which it is a hard one.
  virtual int usualIterations() const { return std::numeric_limits<int>::max(); }

  // Longest motion of a patch in one solve that the method follows well (m).
  virtual double patchStep() const = 0;
};

}  // namespace robot_tissue
