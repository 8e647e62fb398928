// FasCgSolver: how far it is from balance.
#include <algorithm>
#include <cmath>
#include <limits>

#include "simd/field_kernel.h"
#include "solvers/multigrid/cycle/fas_cg_solver.h"

namespace robot_tissue {
namespace {

constexpr double kMostLeft = 0.9;       // of the length left before cycles, to learn from them
constexpr double kMostFactor = 1000.0;  // that long solves may show: what hangs by little moves far
constexpr double kMostSoon = 32.0;      // that a solve's first kLong cycles may show
constexpr int kLong = 15;               // cycles: after as many, the factor is not forgotten
constexpr double kMostAtRest = 8.0;     // that a trial at rest may show
constexpr double kFarther = 1.1;        // than ever from a solve's start: it gets on
constexpr double kRemembered = 0.9;     // of the factor, from cycle to cycle
constexpr double kDip = 0.5;            // of the length left before a cycle: counts as left after
constexpr double kLeastAfter = 0.6;     // of the length left before a cycle: is after it
constexpr int kTrialCycles = 6;         // that show how much of what is left they see
constexpr int kTrialCyclesInPart = 12;  // what is beyond comes later
constexpr double kTrialMotion = 1e-3;   // in spacings
constexpr double kPatchBalance = 1e-5;  // of the force on a patch: what single precision knows
constexpr int kFirstMark = 16;          // cycles: from then on, the latest half tells of slow ones
constexpr int kPatienceInPart = 6;      // cycles that led nowhere: then all is visited
constexpr int kShortest = 4;            // cycles since the mark
constexpr double kMostUnbalanced = 0.1;   // of the greatest force
constexpr double kContactBalance = 0.05;  // of the contacts' force: unbalanced in all
constexpr int kCyclesForBalance = 6;      // that a solve may take for it
constexpr double kFalling = 0.5;          // of the given force: unbalanced, where nothing holds

}  // namespace

// A shape thrown off rest by little goes back to it: there the length left is known, and with it
// what share of it a cycle sees. Slow motions, the last to go, are seen least.
template <typename Real>
void FasCgSolver<Real>::findLeastFactor(const LatticeState& state) {
  ConstrainedState rest{state, {}};
  std::fill(rest.state.displacement.begin(), rest.state.displacement.end(), Vec3::Zero());
  DofConstraints fixed(lattice_, model_);
  fixed.bind(rest);
  std::uint32_t number = 1;
  for (std::size_t node = 0; node < rest.state.displacement.size(); ++node) {
    if (fixed.dirichletMask()[node] == kAllAxes) continue;
    for (int axis = 0; axis < 3; ++axis) {
      number = 1664525U * number + 1013904223U;
      const double share = static_cast<double>(number >> 8) / (1 << 24) - 0.5;
      rest.state.displacement[node][axis] = kTrialMotion * lattice_.spacing() * share;
    }
  }
  levels_->bind(rest, fixed);
  const Field<Real> weight = finest().right_hand_side;
  finest().clearRightHandSide();
  levels_->setDisplacement(rest.state.displacement, fixed.dirichletMask());
  finest().findForces();
  least_factor_ = 1.0;
  const int cycles = levels_->isWhole() ? kTrialCycles : kTrialCyclesInPart;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    levels_->findSmoothMotion();
    const double left = correctionNorm();
    if (cycle > 0 && left > 0.0) {
      const double off = squared(finest().displacement) + levels_->squaredDisplacementBeyond();
      least_factor_ = std::max(least_factor_, std::sqrt(off) / left);
    }
    levels_->go(1.0);
    finest().findForces();
    finest().smoothAndFindForces(steps_);
  }
  finest().right_hand_side = weight;
  least_factor_ = std::min(least_factor_, kMostAtRest);
  factor_ = least_factor_;
}

// Of the motion that the coarse lattices, and each node alone, say is left.
template <typename Real>
double FasCgSolver<Real>::correctionNorm() const {
  return std::sqrt(finest().squaredLocalMotion() + squared(levels_->motion) +
                   levels_->squaredMotionBeyond() +
                   finest().constrained.squaredMotionOf(levels_->group_motion));
}

// Where the solver stands: kOk, kLate while there is hope, kUnconverged.
template <typename Real>
SolveStatus FasCgSolver<Real>::checkConvergence(bool changed) {
  levels_->findSmoothMotion();
  left_before_ = left_;
  left_ = correctionNorm();
  // Under conjugate gradients it rises and falls on its way down.
  const double trend_before = trend_;
  trend_ = conjugate_ ? std::max(left_, kDip * trend_) : left_;
  if (cycles_ > 0) updateErrorFactor(trend_before);
  const double moved =
      std::sqrt(squared(finest().displacement) + levels_->squaredDisplacementBeyond());
  const double unit = std::max(moved, kStill * std::sqrt(free_nodes_ + 1.0));
  error_ = factor_ * trend_ / unit;
  const double gain = cycles_ > 0 ? factor_ * std::min(trend_ / trend_before, 1.0) : 0.0;
  error_after_ = std::max({factor_ - 1.0, gain, kLeastAfter}) * trend_ / unit;
  if (first_left_ < 0.0) {
    first_left_ = left_;
    least_ = std::numeric_limits<double>::infinity();
    mark_left_ = 0.0;
  }
  if (left_ < least_) {
    least_ = left_;
    keepPlace(best_);
    best_error_ = error_;
    last_gain_ = cycles_;
  }
  // What swings far has more left on its way than where it began.
  const double gone = distanceFrom(start_);
  if (!in_contact_ && gone > kFarther * farthest_) {
    farthest_ = gone;
    last_gain_ = cycles_;
  }
  // Contacts, and what was let go, change in ways that are small beside the displacement, but not
  // to them.
  const bool untried = cycles_ == 0 && changed;
  if (cycles_ == 0 && isAtRest()) {
    error_ = error_after_ = left_ = 0.0;
    return SolveStatus::kOk;
  }
  if (!untried && error_after_ <= allowed() && isBalanced()) return SolveStatus::kOk;
  if (cycles_ > 0 && wentTooFar()) return SolveStatus::kUnconverged;
  const int most = in_contact_ ? options_.max_cycles_in_contact : options_.max_cycles;
  const int patience = in_contact_ ? options_.patience_in_contact : options_.patience;
  if (!levels_->isWhole() && cycles_ > last_gain_ + kPatienceInPart) {
    return SolveStatus::kUnconverged;
  }
  const bool hopeless = cycles_ >= most || cycles_ > last_gain_ + patience;
  return hopeless ? SolveStatus::kUnconverged : SolveStatus::kLate;
}

// Of the error, beside what coarse lattices alone miss.
template <typename Real>
double FasCgSolver<Real>::allowed() const {
  const double missed = std::min(missed_, kMostMissed * options_.tolerance);
  return std::sqrt(options_.tolerance * options_.tolerance - missed * missed);
}

// The greatest force out of balance.
template <typename Real>
double FasCgSolver<Real>::unbalanced() const {
  double unbalanced = 0.0;
  for (const auto& values : finest().force) {
    unbalanced = std::max(unbalanced, greatestOf(values.data(), finest().count()));
  }
  return unbalanced;
}

// No force at all: whatever coarse lattices make of rounding.
template <typename Real>
bool FasCgSolver<Real>::isAtRest() const {
  const std::vector<GroupVector>& on_groups = finest().constrained.force;
  return unbalanced() == 0.0 &&
         std::all_of(on_groups.begin(), on_groups.end(),
                     [](const GroupVector& force) { return force.isZero(0.0); });
}

// Sum of what is out of balance.
template <typename Real>
Vec3 FasCgSolver<Real>::netForce() const {
  Vec3 net = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    net[axis] += sumOf(finest().force[at(axis)].data(), finest().count());
  }
  return net;
}

template <typename Real>
Vec3 FasCgSolver<Real>::forceLeft() {
  if (levels_ == nullptr) return Vec3::Zero();
  Vec3 left = netForce();
  for (const GroupVector& force : finest().constrained.force) left += force.template head<3>();
  double unit = 1.0;
  for (const Field<Real>& forces : levels_->findForcesBeyond()) {
    unit *= 4.0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& values = forces[at(axis)];
      left[axis] += unit * sumOf(values.data(), static_cast<int>(values.size()));
    }
  }
  return levels_->modulus() * lattice_.spacing() * lattice_.spacing() * left;
}

// On hard nodes of patches whose places are given.
template <typename Real>
Vec3 FasCgSolver<Real>::patchForce() const {
  Vec3 force = Vec3::Zero();
  for (const int node : loaded_) {
    const int entry = levels_->entryOf(node);
    if (finest().dirichletAxes(entry) != 0) force += finest().wholeForce(entry);
  }
  return force;
}

// What hangs by little moves far under forces that cycles hardly lessen.
template <typename Real>
bool FasCgSolver<Real>::isCalm() const {
  double most = std::max(greatest_, held_);
  for (const GroupVector& load : finest().constrained.right_hand_side) {
    most = std::max(most, load.template head<3>().norm());
  }
  return unbalanced() <= kMostUnbalanced * most;
}

// What went farther is cut back: the rest of the solve would be in vain.
template <typename Real>
bool FasCgSolver<Real>::wentTooFar() const {
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const Vec3 step = levels_->displacementOf(limits_[i].node) - limited_from_[i];
    if (step.norm() > limits_[i].longest) return true;
  }
  return false;
}

// Forces on patches, and on the whole, have found their answer.
template <typename Real>
bool FasCgSolver<Real>::isBalanced() const {
  if (!in_contact_ && !isCalm()) return false;
  const double pushed = finest().constrained.contactForce().norm();
  if (cycles_ < kCyclesForBalance && netForce().norm() > kContactBalance * pushed && pushed > 0.0) {
    return false;
  }
  Vec3 given = Vec3::Zero(), net = Vec3::Zero();
  for (std::size_t group = 0; group < finest().constrained.groups.size(); ++group) {
    const Vec3 load = finest().constrained.right_hand_side[group].template head<3>();
    const Vec3 left = finest().constrained.force[group].template head<3>();
    if (left.norm() > std::max(options_.tolerance, kPatchBalance) * load.norm()) return false;
    given += load;
    net += left;
  }
  if (given.isZero(0.0)) return true;
  net += netForce();
  return net.norm() < kFalling * given.norm();
}

// Cycles went so far, and these were the lengths left before and after them: what was really left
// before is taken to be what they went and the same multiple of what is left after them.
template <typename Real>
void FasCgSolver<Real>::updateErrorFactor(double trend_before) {
  double factor = 0.0;
  if (trend_ < kMostLeft * trend_before) {
    factor = distanceFrom(before_) / (trend_before - trend_);
  }
  if (cycles_ > 1 && trend_ < kMostLeft * first_left_) {
    factor = std::max(factor, distanceFrom(start_) / (first_left_ - trend_));
  }
  if (!in_contact_ && cycles_ >= mark_cycle_ + kShortest && trend_ < kMostLeft * mark_left_) {
    factor = std::max(factor, distanceFrom(mark_) / (mark_left_ - trend_));
  }
  if ((cycles_ & (cycles_ - 1)) == 0 && cycles_ >= kFirstMark) {
    keepPlace(mark_);
    mark_left_ = trend_;
    mark_cycle_ = cycles_;
  }
  if (factor == 0.0) return;
  const bool is_long = !in_contact_ && cycles_ > kLong;
  factor = std::min(std::max(factor, least_factor_), is_long ? kMostFactor : kMostSoon);
  factor_ = std::max(factor, is_long ? factor_ : kRemembered * factor_);
}

template class FasCgSolver<float>;
template class FasCgSolver<double>;

}  // namespace robot_tissue
