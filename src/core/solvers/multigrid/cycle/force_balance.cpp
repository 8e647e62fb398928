#include "solvers/multigrid/cycle/force_balance.h"

#include <algorithm>
#include <cmath>

#include "simd/field_kernel.h"
#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

Vec3 forceOf(const GroupVector& vector) { return vector.head<3>(); }
double sizeOf(const GroupVector& vector) { return vector.head<3>().norm(); }

}  // namespace

template <typename Real>
void ForceBalance<Real>::begin() {
  greatest_at_start_ = shape_.greatestForce();
  greatest_on_patches_ = 0.0;
  for (const GroupVector& force : shape_.finest().constrained.force) {
    greatest_on_patches_ = std::max(greatest_on_patches_, sizeOf(force));
  }
}

// On the finest level alone: coarse levels show forces of rounding even where there are none.
template <typename Real>
bool ForceBalance<Real>::isZero() const {
  const std::vector<GroupVector>& on_groups = shape_.finest().constrained.force;
  return shape_.greatestForce() == 0.0 &&
         std::all_of(on_groups.begin(), on_groups.end(),
                     [](const GroupVector& force) { return force.isZero(0.0); });
}

template <typename Real>
bool ForceBalance<Real>::isReached(const SolveContext& solve) const {
  if (!solve.in_contact && !isCalm(solve)) return false;
  if (solve.cycles < tuning::kCyclesForBalance && !areContactsBalanced()) return false;
  return arePatchesBalanced();
}

// Membranes may have a pressure inside.
template <typename Real>
bool ForceBalance<Real>::isLoaded(const SolveContext& solve) const {
  return solve.in_time || !solve.shape.patches.empty() || shape_.finest().membrane() != nullptr ||
         greatestGiven() > 0.0;
}

// On a node along an axis, as weight: a solve that begins in balance has no other force to compare
// with what is left.
template <typename Real>
double ForceBalance<Real>::greatestGiven() const {
  return greatestIn(shape_.finest().right_hand_side, shape_.finest().count());
}

// A tissue that hangs on little moves far: the error relative to its displacement is small while
// forces are still unbalanced. So the greatest one on a node is compared with those that act. Where
// none does, all that there are but rounding bring the tissue home.
template <typename Real>
bool ForceBalance<Real>::isCalm(const SolveContext& solve) const {
  double most = std::max({greatest_at_start_, greatest_held_, greatestGiven()});
  for (const GroupVector& load : shape_.finest().constrained.right_hand_side) {
    most = std::max(most, sizeOf(load));
  }
  const double share = isLoaded(solve) ? tuning::kMostUnbalanced : tuning::kMostUnloaded;
  if (shape_.greatestForce() <= share * most) return true;
  return !isPushed(solve) && isRounding(solve);
}

// By a force, not by places that are given: these may be where the tissue is at rest.
template <typename Real>
bool ForceBalance<Real>::isPushed(const SolveContext& solve) const {
  const std::vector<GroupVector>& loads = shape_.finest().constrained.right_hand_side;
  return solve.in_time || shape_.finest().membrane() != nullptr || greatestGiven() > 0.0 ||
         !shape_.finest().constrained.contactForce().isZero(0.0) ||
         std::any_of(loads.begin(), loads.end(),
                     [](const GroupVector& load) { return !load.isZero(0.0); });
}

// Of displacements, as of a free piece that went far; or of rest.
template <typename Real>
bool ForceBalance<Real>::isRounding(const SolveContext& solve) const {
  const double motion = std::sqrt(shape_.finest().squaredLocalMotion());
  const double still = tolerance_ * tuning::kStill * std::sqrt(solve.hold.freeNodes() + 1.0);
  return motion <= std::max(still, tuning::kRoundedDigits * shape_.displacementRounding());
}

template <typename Real>
bool ForceBalance<Real>::areContactsBalanced() const {
  const double pushed = shape_.finest().constrained.contactForce().norm();
  return !(pushed > 0.0 && shape_.netForce().norm() > tuning::kContactBalance * pushed);
}

// But for the loads of patches as they are now; what contacts press with, in all.
template <typename Real>
double ForceBalance<Real>::greatestActing() const {
  return std::max({greatest_at_start_, greatest_on_patches_, greatest_held_, greatestGiven(),
                   shape_.finest().constrained.contactForce().norm()});
}

// Patches by force: each, and the whole that they move.
template <typename Real>
bool ForceBalance<Real>::arePatchesBalanced() const {
  const ConstrainedNodes<Real>& constrained = shape_.finest().constrained;
  const double least = std::max(tuning::kLeastLoad * greatestActing(), tuning::kStill);
  Vec3 given = Vec3::Zero(), net = Vec3::Zero();
  for (std::size_t group = 0; group < constrained.groups.size(); ++group) {
    const Vec3 load = forceOf(constrained.right_hand_side[group]);
    const Vec3 left = forceOf(constrained.force[group]);
    const double scale = std::max(load.norm(), least);
    if (left.norm() > std::max(tolerance_, tuning::kPatchBalance) * scale) return false;
    given += load;
    net += left;
  }
  if (given.isZero(0.0)) return true;
  net += shape_.netForce();
  return net.norm() < tuning::kFalling * std::max(given.norm(), least);
}

// The sum of all unbalanced forces is the difference between what goes into the tissue and what its
// held nodes bear.
template <typename Real>
bool ForceBalance<Real>::isSettled(const std::vector<int>& loaded, double share) const {
  const double given = heldForce(loaded).norm() + shape_.finest().constrained.contactForce().norm();
  return shape_.netForce().norm() <= share * tolerance_ * given || given == 0.0;
}

// On those of the nodes whose places are given.
template <typename Real>
Vec3 ForceBalance<Real>::heldForce(const std::vector<int>& loaded) const {
  Vec3 force = Vec3::Zero();
  for (const int node : loaded) {
    const int entry = shape_.levels().grid().entryOf(node);
    if (shape_.finest().dirichletAxes(entry) != 0) force += shape_.finest().wholeForce(entry);
  }
  return force;
}

template <typename Real>
double ForceBalance<Real>::residual(const ConstrainedState& state) const {
  double left = shape_.greatestForce();
  for (std::size_t index = 0; index < state.patches.size(); ++index) {
    if (!byForce(state.patches[index])) continue;
    left = std::max(left, sizeOf(shape_.finest().constrained.force[index]));
  }
  return left / std::max({greatest_held_, greatest_at_start_, greatestGiven(), tuning::kStill});
}

// Level by level: a unit of force is four times the finer level's.
template <typename Real>
Vec3 forceLeftOn(CompositeShape<Real>& shape, double spacing) {
  Vec3 left = shape.netForce();
  for (const GroupVector& force : shape.finest().constrained.force) left += forceOf(force);
  double unit = 1.0;
  for (const Field<Real>& forces : shape.levels().uncovered().findForces()) {
    unit *= 4.0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& values = forces[at(axis)];
      left[axis] += unit * sumOf(values.data(), static_cast<int>(values.size()));
    }
  }
  return shape.levels().grid().modulus() * spacing * spacing * left;
}

template class ForceBalance<float>;
template class ForceBalance<double>;
template Vec3 forceLeftOn(CompositeShape<float>&, double);
template Vec3 forceLeftOn(CompositeShape<double>&, double);

}  // namespace robot_tissue
