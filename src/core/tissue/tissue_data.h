// What the tissue is, what acts on it, and what the last solve left: what all parts behind Tissue
// share. In brackets: which of them change it, besides `restore` and TissueStates.
#pragma once

#include <vector>

#include "saving/saved_state.h"
#include "tissue/body.h"
#include "tissue/history.h"
#include "tissue/method_pair.h"
#include "tissue/piece_registry.h"
#include "tissue/solve_bounds.h"
#include "tissue/solve_outcome.h"
#include "tissue/standing_loads.h"
#include "tissue/threads.h"
#include "tissue/tissue_motion.h"

namespace robot_tissue {

struct TissueData {
  // Throws InputError, as Tissue.
  TissueData(const TissueConfig& tissue, const SolverConfig& solver);

  double stepLength() const;     // Tissue::stepLength (m)
  bool goesThroughTime() const;  // Tissue::goesThroughTime
  bool isLate() const { return outcome.is_late || loads.isLoading(); }
  // Of pieces that gravity pulls and nothing bears; ascending.
  std::vector<int> hangingNodes() const;
  // Likewise by given forces, where the method looks for a balance.
  PieceRegistry::Adrift adrift() const;
  Tissue::Shape shape() const;
  void restore(const Tissue::Shape& shape);
  SavedState saved() const;
  // Loads or cuts are others, the shape is not yet: time is to move it.
  SolveReport asItIs();
  // In the place of the earlier ones of tools. Until the next solve each answers what it was last
  // told to answer, and new ones nothing.
  void putToolPatches(std::vector<LoadingPatch> of_tools);
  void beginAside();
  void endAside();

  // The surface is that of the shape and of where patches have their nodes (Body::deform).
  void deformSurface(Body::OffPoint of_tools = drawnOff);
  // On other cells: the surface, with its vertices at rest, and what threads and ties hang on.
  void rebuildSurface();
  void renewTies();

  Body body;             // [LoadStepSolver, Surgery, LoadProgram, TimeStepping]
  StandingLoads loads;   // [LoadStepSolver, Surgery, LoadStepping, LoadProgram]
  SolveOutcome outcome;  // [all but TissueForces]
  Threads threads;       // of sutures [LoadStepSolver, Suturing, LoadProgram]
  History history;       // of what changed the topology [TopologyChange]
  MethodPair methods;    // [LoadStepSolver, LoadProgram]
  TissueMotion motion;   // [Surgery, LoadProgram, TimeStepping, Tissue]
  PieceRegistry pieces;  // [Surgery]
  SolveBounds bounds;    // [LoadStepSolver, Tissue]

 private:
  void rebindThreads();
};

}  // namespace robot_tissue
