#include "solvers/multigrid/cycle/trial_at_rest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

// By numbers that are the same each time (a linear congruential generator: Numerical Recipes).
void throwOffRest(const DofConstraints& hold, double spacing, std::vector<Vec3>& displacement) {
  std::uint32_t number = 1;
  for (std::size_t node = 0; node < displacement.size(); ++node) {
    if (hold.dirichletMask()[node] == kAllAxes) continue;
    for (int axis = 0; axis < 3; ++axis) {
      number = 1664525U * number + 1013904223U;
      const double share = static_cast<double>(number >> 8) / (1 << 24) - 0.5;
      displacement[node][axis] = tuning::kTrialMotion * spacing * share;
    }
  }
}

}  // namespace

// The length left is that of the displacement: what share of it do cycles see? Not at once: slow
// motions, the last to go, are seen least. Where cycles that are not searched along go astray, as
// of a bar two cells across, or to and fro about rest, there is no telling.
template <typename Real>
double leastErrorFactor(CompositeShape<Real>& shape, const Lattice& lattice,
                        const ElasticModel& model, const LatticeState& state, int smoother_steps) {
  ConstrainedState rest{state, {}};
  std::fill(rest.state.displacement.begin(), rest.state.displacement.end(), Vec3::Zero());
  DofConstraints fixed(lattice, model);
  fixed.bind(rest);
  throwOffRest(fixed, lattice.spacing(), rest.state.displacement);
  GridHierarchy<Real>& levels = shape.levels();
  levels.constraints().bind(rest, fixed);
  const Field<Real> weight = shape.finest().right_hand_side;
  shape.finest().clearRightHandSide();
  levels.displacements().take(rest.state.displacement, fixed.dirichletMask());
  levels.renewMembranes();
  levels.forgetMembranes();
  shape.finest().findForces();
  const double thrown = shape.displacementNorm();
  double least = 1.0;
  const int in_whole =
      levels.grid().hasEnds() ? tuning::kTrialCyclesBetweenEnds : tuning::kTrialCycles;
  const int cycles = levels.isWhole() ? in_whole : tuning::kTrialCyclesInPart;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    levels.correction().find();
    const double left = shape.displacementNorm(), seen = shape.correctionNorm();
    const bool goes_to_and_fro = cycle + 1 == cycles && seen > tuning::kToAndFro * left;
    if (!(left <= tuning::kAstray * thrown) || goes_to_and_fro) {
      least = tuning::kMostAtRest;
      break;
    }
    if (cycle > 0 && seen > 0.0) least = std::max(least, left / seen);
    shape.correctAndSmooth(1.0, smoother_steps);
  }
  shape.finest().right_hand_side = weight;
  return std::min(least, tuning::kMostAtRest);
}

template double leastErrorFactor(CompositeShape<float>&, const Lattice&, const ElasticModel&,
                                 const LatticeState&, int);
template double leastErrorFactor(CompositeShape<double>&, const Lattice&, const ElasticModel&,
                                 const LatticeState&, int);

}  // namespace robot_tissue
