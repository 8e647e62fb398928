#include "solvers/multigrid/cycle/trial_at_rest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

// Numbers that are the same each time, of -1/2 to 1/2 (a linear congruential generator: Numerical
// Recipes).
class TrialNumbers {
 public:
  double next() {
    number_ = 1664525U * number_ + 1013904223U;
    return static_cast<double>(number_ >> 8) / (1 << 24) - 0.5;
  }
  Vec3 nextVector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  std::uint32_t number_ = 1;
};

template <typename Real>
class TrialAtRest {
 public:
  TrialAtRest(CompositeShape<Real>& shape, const Lattice& lattice, const ElasticModel& model,
              const LatticeState& state, int smoother_steps)
      : shape_(shape),
        lattice_(lattice),
        rest_{state, {}},
        fixed_(lattice, model),
        smoother_steps_(smoother_steps) {
    auto& displacement = rest_.state.displacement;
    std::fill(displacement.begin(), displacement.end(), Vec3::Zero());
    fixed_.bind(rest_);
    shape_.levels().constraints().bind(rest_, fixed_);
    weight_ = shape_.finest().right_hand_side;
    shape_.finest().clearRightHandSide();
  }
  ~TrialAtRest() { shape_.finest().right_hand_side = weight_; }
  TrialAtRest(const TrialAtRest&) = delete;
  TrialAtRest& operator=(const TrialAtRest&) = delete;

  double ofRoughMotions();
  double ofSmoothMotions();

 private:
  using Thrown = std::function<Vec3(int node)>;
  void throwOffRest(const Thrown& thrown);

  CompositeShape<Real>& shape_;
  const Lattice& lattice_;
  ConstrainedState rest_;
  DofConstraints fixed_;
  int smoother_steps_;
  Field<Real> weight_;
};

// Of the free nodes, in spacings.
template <typename Real>
void TrialAtRest<Real>::throwOffRest(const Thrown& thrown) {
  std::vector<Vec3>& displacement = rest_.state.displacement;
  for (std::size_t node = 0; node < displacement.size(); ++node) {
    if (fixed_.dirichletMask()[node] == kAllAxes) continue;
    displacement[node] = tuning::kTrialMotion * lattice_.spacing() * thrown(static_cast<int>(node));
  }
  GridHierarchy<Real>& levels = shape_.levels();
  levels.displacements().take(displacement, fixed_.dirichletMask());
  levels.renewMembranes();
  levels.forgetMembranes();
  shape_.finest().findForces();
}

// The length left is that of the displacement: what share of it do cycles see? Not at once: slow
// motions, the last to go, are seen least. Where cycles that are not searched along go astray, as
// of a bar two cells across, or to and fro about rest, there is no telling.
template <typename Real>
double TrialAtRest<Real>::ofRoughMotions() {
  TrialNumbers numbers;
  throwOffRest([&](int) { return numbers.nextVector(); });
  const GridHierarchy<Real>& levels = shape_.levels();
  const double thrown = shape_.displacementNorm();
  const int in_whole =
      levels.grid().hasEnds() ? tuning::kTrialCyclesBetweenEnds : tuning::kTrialCycles;
  const int cycles = levels.isWhole() ? in_whole : tuning::kTrialCyclesInPart;
  double least = 1.0;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    shape_.levels().correction().find();
    const double left = shape_.displacementNorm(), seen = shape_.correctionNorm();
    const bool goes_to_and_fro = cycle + 1 == cycles && seen > tuning::kToAndFro * left;
    if (!(left <= tuning::kAstray * thrown) || goes_to_and_fro) return tuning::kMostAtRest;
    if (cycle > 0 && seen > 0.0) least = std::max(least, left / seen);
    shape_.correctAndSmooth(1.0, smoother_steps_);
  }
  return std::min(least, tuning::kMostAtRest);
}

// Tissue that hangs by little, as a block by its corner, turns about that as a whole, which takes
// cycles hundreds of times as long as what else it does. Rough motions have next to none of it. So
// it is thrown into a linear and quadratic field, and cycles go on as long as what is left hardly
// falls and is seen less and less.
template <typename Real>
double TrialAtRest<Real>::ofSmoothMotions() {
  const Box bounds = lattice_.bounds();
  TrialNumbers numbers;
  Eigen::Matrix3d linear, quadratic;
  for (auto* matrix : {&linear, &quadratic}) {
    for (int column = 0; column < 3; ++column) matrix->col(column) = numbers.nextVector();
  }
  throwOffRest([&](int node) -> Vec3 {
    const Vec3 place = restPosition(lattice_, *rest_.state.cells, node) - bounds.min();
    const Vec3 share = place / bounds.sizes().maxCoeff();
    return linear * share + quadratic * share.cwiseProduct(share);
  });
  const double thrown = shape_.displacementNorm();
  double before = thrown;
  double factor = 1.0;
  for (int cycle = 0; cycle < tuning::kMostSlowCycles; ++cycle) {
    shape_.levels().correction().find();
    const double left = shape_.displacementNorm(), seen = shape_.correctionNorm();
    const double factor_before = std::exchange(factor, left / seen);
    if (!(factor <= tuning::kFree)) return 1.0;
    const bool is_slow =
        left > tuning::kHardlyFalls * before && factor > tuning::kHidesMore * factor_before;
    const bool is_fast = cycle == tuning::kFirstFastCycle && left < tuning::kFast * thrown;
    if (is_fast || (cycle >= tuning::kFirstSlowCycle && !is_slow)) break;
    before = left;
    shape_.correctAndSmooth(1.0, smoother_steps_);
  }
  return std::min(factor, tuning::kMostOfSlow);
}

}  // namespace

// What hangs by little counts where it is clear that it does.
template <typename Real>
double leastErrorFactor(CompositeShape<Real>& shape, const Lattice& lattice,
                        const ElasticModel& model, const LatticeState& state, int smoother_steps) {
  TrialAtRest<Real> trial(shape, lattice, model, state, smoother_steps);
  const double rough = trial.ofRoughMotions();
  const GridHierarchy<Real>& levels = shape.levels();
  if (!levels.isWhole() || levels.grid().hasEnds() || model.hasMembranes()) return rough;
  const double smooth = trial.ofSmoothMotions();
  return smooth > tuning::kClearlySlow ? std::max(rough, smooth) : rough;
}

template double leastErrorFactor(CompositeShape<float>&, const Lattice&, const ElasticModel&,
                                 const LatticeState&, int);
template double leastErrorFactor(CompositeShape<double>&, const Lattice&, const ElasticModel&,
                                 const LatticeState&, int);

}  // namespace robot_tissue
