// FasCgSolver: how it goes on towards balance.
#include <algorithm>
#include <cmath>
#include <utility>

#include "simd/field_kernel.h"
#include "solvers/multigrid/cycle/fas_cg_solver.h"

namespace robot_tissue {
namespace {

constexpr double kBlownUp = 100.0;      // times the length left when a solve begins
constexpr double kAstray = 3.0;         // likewise, where a solve ends late
constexpr double kSoonTouches = 0.1;    // spacings: then a late solve's last steps are careful
constexpr double kSlow = 0.3;           // of the length left before a cycle: then gradients help
constexpr double kFlatEnough = 0.3;     // of the slope along a direction: no need to look further
constexpr double kWorthKeeping = 0.05;  // of the last direction, beside a new one
constexpr int kTrials = 8;              // of the length along a direction
constexpr double kForceShare = 2.0;     // of the tolerance: what forces may disagree by
constexpr double kMoreInContact = 1.3;  // steps of the smoother in a later cycle, over the first's
constexpr int kMostSettling = 3;        // rounds of the smoother, for the forces' sake
constexpr int kPlainSteps = 8;          // of the smoother, where a cycle led nowhere

}  // namespace

template <typename Real>
void FasCgSolver<Real>::keepPlace(Vector& vector) const {
  vector.nodes = finest().displacement;
  vector.groups = finest().constrained.motion;
  vector.beyond = levels_->placesBeyond();
}

template <typename Real>
void FasCgSolver<Real>::keepForce(Vector& vector) {
  vector.nodes = finest().force;
  vector.groups = finest().constrained.force;
  vector.beyond = levels_->findForcesBeyond();
}

template <typename Real>
void FasCgSolver<Real>::putBack(const Vector& vector) {
  finest().constrained.motion = vector.groups;
  finest().displacement = vector.nodes;
  levels_->putBeyond(vector.beyond);
}

template <typename Real>
void FasCgSolver<Real>::move(const Vector& step, double alpha) {
  finest().moveBy(step.nodes, step.groups, alpha);
  levels_->moveBeyond(step.beyond, alpha);
  finest().findForces();
}

template <typename Real>
double FasCgSolver<Real>::work(const Vector& force, const Vector& motion) const {
  double work = GridHierarchy<Real>::workBeyond(force.beyond, motion.beyond);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    work += dotOf(force.nodes[axis].data(), motion.nodes[axis].data(), finest().count());
  }
  for (std::size_t group = 0; group < motion.groups.size(); ++group) {
    work += force.groups[group].dot(motion.groups[group]);
  }
  return work;
}

// Of the forces as they are now.
template <typename Real>
double FasCgSolver<Real>::workOf(const Vector& motion) {
  return nearWorkOf(motion) +
         GridHierarchy<Real>::workBeyond(levels_->findForcesBeyond(), motion.beyond);
}

// In the open part alone.
template <typename Real>
double FasCgSolver<Real>::nearWorkOf(const Vector& motion) const {
  double work = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    work += dotOf(finest().force[axis].data(), motion.nodes[axis].data(), finest().count());
  }
  for (std::size_t group = 0; group < motion.groups.size(); ++group) {
    work += finest().constrained.force[group].dot(motion.groups[group]);
  }
  return work;
}

template <typename Real>
void FasCgSolver<Real>::add(const Vector& other, double alpha, Vector& to) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addShare(other.nodes[axis].data(), static_cast<Real>(alpha), to.nodes[axis].data(),
             finest().count());
  }
  for (std::size_t group = 0; group < to.groups.size(); ++group) {
    to.groups[group] += alpha * other.groups[group];
  }
  for (std::size_t level = 0; level < to.beyond.size(); ++level) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      addShare(other.beyond[level][axis].data(), static_cast<Real>(alpha),
               to.beyond[level][axis].data(), static_cast<int>(to.beyond[level][axis].size()));
    }
  }
}

template <typename Real>
double FasCgSolver<Real>::squared(const Field<Real>& field) const {
  double squared = 0.0;
  for (const auto& values : field) {
    squared += dotOf(values.data(), values.data(), finest().count());
  }
  return squared;
}

template <typename Real>
double FasCgSolver<Real>::distanceFrom(const Vector& vector) const {
  double squared = levels_->squaredDistanceBeyond(vector.beyond);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += squaredDistance(finest().displacement[axis].data(), vector.nodes[axis].data(),
                               finest().count());
  }
  return std::sqrt(squared);
}

template <typename Real>
double FasCgSolver<Real>::longestSmooth() const {
  double longest = 0.0;
  for (const auto& values : levels_->motion) {
    longest = std::max(longest, greatestOf(values.data(), finest().count()));
  }
  return longest;
}

// Goes on, or back, the way that the last step went, as far as the forces work along it.
template <typename Real>
bool FasCgSolver<Real>::warmStart() {
  keepPlace(before_);
  last_step_.groups.assign(finest().constrained.groups.size(), GroupVector::Zero());
  const double slope = nearWorkOf(last_step_);
  if (slope == 0.0 || !std::isfinite(slope)) return false;
  const double alpha = slope > 0.0 ? 1.0 : -1.0;
  const double local = ended_late_ ? finest().squaredLocalMotion() : 0.0;
  move(last_step_, alpha);
  const double here = nearWorkOf(last_step_);
  if (std::abs(here) <= kFlatEnough * std::abs(slope)) return isStepGood(local);
  const double best = slope / (slope - here);  // of `share`, were the energy quadratic
  if (!std::isfinite(here) || !(best > 0.0)) {
    putBack(before_);
    finest().findForces();
    return false;
  }
  move(last_step_, alpha * (std::min(best, 2.0) - 1.0));
  return isStepGood(local);
}

// A step that ended late also made up for what was left before, which is not to be gone on with.
// local: the squared motion left to nodes alone, before.
template <typename Real>
bool FasCgSolver<Real>::isStepGood(double local) {
  if (!ended_late_ || finest().squaredLocalMotion() <= local) return true;
  putBack(before_);
  finest().findForces();
  return false;
}

template <typename Real>
SolveStatus FasCgSolver<Real>::iterate(bool changed, bool warm_started, const Budget& budget) {
  keepPlace(start_);
  first_left_ = -1.0;
  farthest_ = 0.0;
  fresh_ = true;
  conjugate_ = false;
  SolveStatus status = checkConvergence(changed);
  for (; status == SolveStatus::kLate; status = checkConvergence(changed)) {
    if (cycles_ > 0 && budget.isSpent()) break;
    cgCycle();
    ++cycles_;
  }
  if (status == SolveStatus::kLate) endLate();
  // What is in balance stays, bit for bit.
  const bool moves = cycles_ > 0 || warm_started || error_ > options_.tolerance;
  if (status == SolveStatus::kOk && moves && left_ > 0.0) {
    finish();
    settleForces();
    return status;
  }
  // What slips has more left on its way: only a shape that blew up goes back.
  if (status == SolveStatus::kUnconverged && !(left_ <= kBlownUp * first_left_)) {
    putBack(best_);
    finest().findForces();
    error_ = best_error_;
  }
  return status;
}

// Cut short, a cycle leaves what is rough unbalanced: springs in contact, the stiffest of all,
// would tell forces that nothing answers. What went astray is not told.
template <typename Real>
void FasCgSolver<Real>::endLate() {
  finest().constrained.soon_touches = kSoonTouches;
  if (left_ <= kAstray * first_left_) {
    finest().findForces();
    finest().smoothAndFindForces(steps_);
    settleForces();
  } else {
    goPlainly(best_);
    error_ = best_error_;
  }
  finest().constrained.soon_touches = 0.0;
}

// The last motion that the coarse lattices found.
template <typename Real>
void FasCgSolver<Real>::finish() {
  error_ = error_after_;
  if (conjugate_) keepPlace(before_);
  const double most = unbalanced();
  levels_->go(1.0);
  finest().findForces();
  finest().smoothAndFindForces(1);
  if (conjugate_ && unbalanced() > most) {
    putBack(before_);
    finest().findForces();
    cgCycle();
  }
}

// What is rough beside a patch hardly shows in displacements, but in its force. What is unbalanced
// in all is what the forces on the tissue's ends do not agree by.
template <typename Real>
void FasCgSolver<Real>::settleForces() {
  for (int round = 0; round < kMostSettling; ++round) {
    const double given = patchForce().norm() + finest().constrained.contactForce().norm();
    if (netForce().norm() <= kForceShare * options_.tolerance * given || given == 0.0) return;
    finest().smoothAndFindForces(steps());
  }
}

// One cycle.
template <typename Real>
void FasCgSolver<Real>::cgCycle() {
  if (!(left_ <= kBlownUp * first_left_)) {
    goPlainly(best_);
    return keepPlace(before_);
  }
  keepPlace(before_);
  const double longest = longestSmooth();
  const double alpha = longest > options_.line_step ? options_.line_step / longest : 1.0;
  if (alpha == 1.0 && isSteady()) {
    levels_->go(1.0);
    finest().findForces();
    finest().smoothAndFindForces(steps());
    fresh_ = true;
    conjugate_ = false;
    return;
  }
  keepForce(force_before_);
  levels_->go(alpha);
  finest().findForces();
  finest().smoothAndFindForces(steps());
  keepPlace(cg_step_);
  add(before_, -1.0, cg_step_);
  const double own_slope = work(force_before_, cg_step_);
  double slope = own_slope;
  const double beta = fresh_ ? 0.0 : (own_slope - work(earlier_force_, cg_step_)) / previous_slope_;
  if (beta > kWorthKeeping && left_ > kSlow * left_before_) {
    const double along = work(force_before_, search_direction_);
    if (own_slope + beta * along > 0.0) {
      slope += beta * along;
      add(search_direction_, beta, cg_step_);
      putBack(before_);
      move(cg_step_, 1.0);
    }
  }
  conjugate_ = !fresh_ && left_ > kSlow * left_before_;
  fresh_ = false;
  previous_slope_ = own_slope;
  std::swap(earlier_force_, force_before_);
  if (own_slope > 0.0 && lineSearch(cg_step_, slope, workOf(cg_step_))) {
    std::swap(search_direction_, cg_step_);
  } else {
    goPlainly(before_);
  }
}

// Where parts are open, cycles that get on need no looking back at what they did: forces beyond
// cost more than a look.
template <typename Real>
bool FasCgSolver<Real>::isSteady() const {
  return !levels_->isWhole() && left_ <= kBlownUp * first_left_ &&
         (cycles_ == 0 || left_ <= kSlow * left_before_);
}

// Springs in contact are the stiffest of all, and begin and end: what is rough beside them lasts.
// Where tissue slips, the first cycle is all that a solve has.
template <typename Real>
int FasCgSolver<Real>::steps() const {
  const bool more = in_contact_ && cycles_ > 0;
  return more ? static_cast<int>(std::lround(kMoreInContact * steps_)) : steps_;
}

// Steps of the smoother alone.
template <typename Real>
void FasCgSolver<Real>::goPlainly(const Vector& from) {
  putBack(from);
  finest().findForces();
  finest().smoothAndFindForces(kPlainSteps);
  fresh_ = true;
}

// Having gone along the way once: further or back, to where the forces no longer work along it.
// `slope`: what they did at its start. False: it leads nowhere.
template <typename Real>
bool FasCgSolver<Real>::lineSearch(const Vector& step, double slope, double slope_here) {
  double low = 0.0, low_slope = slope, high = 0.0, high_slope = 0.0;
  bool bracketed = false;
  double alpha = 1.0, here = slope_here;
  for (int trial = 0; trial < kTrials; ++trial) {
    if (std::abs(here) <= kFlatEnough * slope) return true;
    if (here > 0.0 && std::isfinite(here)) {
      low = alpha;
      low_slope = here;
    } else {
      high = alpha;
      high_slope = here;
      bracketed = true;
    }
    if (!bracketed) {
      const double secant = low_slope < slope ? alpha * slope / (slope - low_slope) : 2.0 * alpha;
      if (trial > 1) return true;
      alpha = std::min({std::max(secant, 1.1 * alpha), 4.0 * alpha});
    } else if (std::isfinite(high_slope)) {
      const double across = low_slope / (low_slope - high_slope);
      alpha = low + std::min(std::max(across, 0.1), 0.9) * (high - low);
    } else {
      alpha = 0.5 * (low + high);
    }
    putBack(before_);
    move(step, alpha);
    here = workOf(step);
  }
  return low > 0.0 && std::isfinite(here);
}

template class FasCgSolver<float>;
template class FasCgSolver<double>;

}  // namespace robot_tissue
