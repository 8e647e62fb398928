// CourseIn: how it goes on towards balance.
#include <algorithm>
#include <cmath>
#include <utility>

#include "course_in.h"
#include "robot_tissue/core/field_kernel.h"

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
void CourseIn<Real>::keepPlace(Vector& vector) const {
  vector.nodes = finest().displacement;
  vector.groups = finest().firm.motion;
  vector.beyond = levels_->placesBeyond();
}

template <typename Real>
void CourseIn<Real>::keepForce(Vector& vector) {
  vector.nodes = finest().force;
  vector.groups = finest().firm.force;
  vector.beyond = levels_->findForcesBeyond();
}

template <typename Real>
void CourseIn<Real>::putBack(const Vector& vector) {
  finest().firm.motion = vector.groups;
  finest().displacement = vector.nodes;
  levels_->putBeyond(vector.beyond);
}

template <typename Real>
void CourseIn<Real>::move(const Vector& way, double share) {
  finest().moveBy(way.nodes, way.groups, share);
  levels_->moveBeyond(way.beyond, share);
  finest().findForces(true);
}

template <typename Real>
double CourseIn<Real>::work(const Vector& force, const Vector& motion) const {
  double work = LatticeLevels<Real>::workBeyond(force.beyond, motion.beyond);
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
double CourseIn<Real>::workOf(const Vector& motion) {
  return nearWorkOf(motion) +
         LatticeLevels<Real>::workBeyond(levels_->findForcesBeyond(), motion.beyond);
}

// In the open part alone.
template <typename Real>
double CourseIn<Real>::nearWorkOf(const Vector& motion) const {
  double work = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    work += dotOf(finest().force[axis].data(), motion.nodes[axis].data(), finest().count());
  }
  for (std::size_t group = 0; group < motion.groups.size(); ++group) {
    work += finest().firm.force[group].dot(motion.groups[group]);
  }
  return work;
}

template <typename Real>
void CourseIn<Real>::add(const Vector& other, double share, Vector& to) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addShare(other.nodes[axis].data(), static_cast<Real>(share), to.nodes[axis].data(),
             finest().count());
  }
  for (std::size_t group = 0; group < to.groups.size(); ++group) {
    to.groups[group] += share * other.groups[group];
  }
  for (std::size_t level = 0; level < to.beyond.size(); ++level) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      addShare(other.beyond[level][axis].data(), static_cast<Real>(share),
               to.beyond[level][axis].data(), static_cast<int>(to.beyond[level][axis].size()));
    }
  }
}

template <typename Real>
double CourseIn<Real>::squared(const Field<Real>& field) const {
  double squared = 0.0;
  for (const auto& values : field) {
    squared += dotOf(values.data(), values.data(), finest().count());
  }
  return squared;
}

template <typename Real>
double CourseIn<Real>::distanceFrom(const Vector& vector) const {
  double squared = levels_->squaredDistanceBeyond(vector.beyond);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += squaredDistance(finest().displacement[axis].data(), vector.nodes[axis].data(),
                               finest().count());
  }
  return std::sqrt(squared);
}

template <typename Real>
double CourseIn<Real>::longestSmooth() const {
  double longest = 0.0;
  for (const auto& values : levels_->motion) {
    longest = std::max(longest, greatestOf(values.data(), finest().count()));
  }
  return longest;
}

// Goes on, or back, the way that the last step went, as far as the forces work along it.
template <typename Real>
bool CourseIn<Real>::carryOn() {
  keepPlace(before_);
  last_way_.groups.assign(finest().firm.groups.size(), GroupVector::Zero());
  const double slope = nearWorkOf(last_way_);
  if (slope == 0.0 || !std::isfinite(slope)) return false;
  const double share = slope > 0.0 ? 1.0 : -1.0;
  const double local = ended_late_ ? finest().squaredLocalMotion() : 0.0;
  move(last_way_, share);
  const double here = nearWorkOf(last_way_);
  if (std::abs(here) <= kFlatEnough * std::abs(slope)) return isWayGood(local);
  const double best = slope / (slope - here);  // of `share`, were the energy quadratic
  if (!std::isfinite(here) || !(best > 0.0)) {
    putBack(before_);
    finest().findForces(true);
    return false;
  }
  move(last_way_, share * (std::min(best, 2.0) - 1.0));
  return isWayGood(local);
}

// A step that ended late also made up for what was left before, which is not to be gone on with.
// local: the squared motion left to nodes alone, before.
template <typename Real>
bool CourseIn<Real>::isWayGood(double local) {
  if (!ended_late_ || finest().squaredLocalMotion() <= local) return true;
  putBack(before_);
  finest().findForces(true);
  return false;
}

template <typename Real>
SolveStatus CourseIn<Real>::iterate(bool changed, bool carried_on, const Budget& budget) {
  keepPlace(start_);
  first_left_ = -1.0;
  farthest_ = 0.0;
  fresh_ = true;
  conjugate_ = false;
  SolveStatus status = look(changed);
  for (; status == SolveStatus::kLate; status = look(changed)) {
    if (cycles_ > 0 && budget.isSpent()) break;
    advance();
    ++cycles_;
  }
  if (status == SolveStatus::kLate) endLate();
  // What is in balance stays, bit for bit.
  const bool moves = cycles_ > 0 || carried_on || error_ > options_.tolerance;
  if (status == SolveStatus::kOk && moves && left_ > 0.0) {
    finish();
    settleForces();
    return status;
  }
  // What slips has more left on its way: only a shape that blew up goes back.
  if (status == SolveStatus::kUnconverged && !(left_ <= kBlownUp * first_left_)) {
    putBack(best_);
    finest().findForces(true);
    error_ = best_error_;
  }
  return status;
}

// Cut short, a cycle leaves what is rough unbalanced: springs in contact, the stiffest of all,
// would tell forces that nothing answers. What went astray is not told.
template <typename Real>
void CourseIn<Real>::endLate() {
  finest().firm.soon_touches = kSoonTouches;
  if (left_ <= kAstray * first_left_) {
    finest().findForces(true);
    finest().smooth(steps_, true);
    settleForces();
  } else {
    goPlainly(best_);
    error_ = best_error_;
  }
  finest().firm.soon_touches = 0.0;
}

// The last motion that the coarse lattices found.
template <typename Real>
void CourseIn<Real>::finish() {
  error_ = error_after_;
  if (conjugate_) keepPlace(before_);
  const double most = unbalanced();
  levels_->go(1.0);
  finest().findForces(true);
  finest().smooth(1, true);
  if (conjugate_ && unbalanced() > most) {
    putBack(before_);
    finest().findForces(true);
    advance();
  }
}

// What is rough beside a patch hardly shows in displacements, but in its force. What is unbalanced
// in all is what the forces on the tissue's ends do not agree by.
template <typename Real>
void CourseIn<Real>::settleForces() {
  for (int round = 0; round < kMostSettling; ++round) {
    const double given = patchForce().norm() + finest().firm.contactForce().norm();
    if (netForce().norm() <= kForceShare * options_.tolerance * given || given == 0.0) return;
    finest().smooth(steps(), true);
  }
}

// One cycle.
template <typename Real>
void CourseIn<Real>::advance() {
  if (!(left_ <= kBlownUp * first_left_)) {
    goPlainly(best_);
    return keepPlace(before_);
  }
  keepPlace(before_);
  const double longest = longestSmooth();
  const double share = longest > options_.line_step ? options_.line_step / longest : 1.0;
  if (share == 1.0 && isSteady()) {
    levels_->go(1.0);
    finest().findForces(true);
    finest().smooth(steps(), true);
    fresh_ = true;
    conjugate_ = false;
    return;
  }
  keepForce(force_before_);
  levels_->go(share);
  finest().findForces(true);
  finest().smooth(steps(), true);
  keepPlace(way_);
  add(before_, -1.0, way_);
  const double promised = work(force_before_, way_);
  double slope = promised;
  const double share_kept = fresh_ ? 0.0 : (promised - work(earlier_force_, way_)) / promised_;
  if (share_kept > kWorthKeeping && left_ > kSlow * left_before_) {
    const double along = work(force_before_, direction_);
    if (promised + share_kept * along > 0.0) {
      slope += share_kept * along;
      add(direction_, share_kept, way_);
      putBack(before_);
      move(way_, 1.0);
    }
  }
  conjugate_ = !fresh_ && left_ > kSlow * left_before_;
  fresh_ = false;
  promised_ = promised;
  std::swap(earlier_force_, force_before_);
  if (promised > 0.0 && searchAlong(way_, slope, workOf(way_))) {
    std::swap(direction_, way_);
  } else {
    goPlainly(before_);
  }
}

// Where parts are open, cycles that get on need no looking back at what they did: forces beyond
// cost more than a look.
template <typename Real>
bool CourseIn<Real>::isSteady() const {
  return !levels_->isWhole() && left_ <= kBlownUp * first_left_ &&
         (cycles_ == 0 || left_ <= kSlow * left_before_);
}

// Springs in contact are the stiffest of all, and begin and end: what is rough beside them lasts.
// Where tissue slips, the first cycle is all that a solve has.
template <typename Real>
int CourseIn<Real>::steps() const {
  const bool more = in_contact_ && cycles_ > 0;
  return more ? static_cast<int>(std::lround(kMoreInContact * steps_)) : steps_;
}

// Steps of the smoother alone.
template <typename Real>
void CourseIn<Real>::goPlainly(const Vector& from) {
  putBack(from);
  finest().findForces(true);
  finest().smooth(kPlainSteps, true);
  fresh_ = true;
}

// Having gone along the way once: further or back, to where the forces no longer work along it.
// `slope`: what they did at its start. False: it leads nowhere.
template <typename Real>
bool CourseIn<Real>::searchAlong(const Vector& way, double slope, double slope_here) {
  double low = 0.0, low_slope = slope, high = 0.0, high_slope = 0.0;
  bool bracketed = false;
  double share = 1.0, here = slope_here;
  for (int trial = 0; trial < kTrials; ++trial) {
    if (std::abs(here) <= kFlatEnough * slope) return true;
    if (here > 0.0 && std::isfinite(here)) {
      low = share;
      low_slope = here;
    } else {
      high = share;
      high_slope = here;
      bracketed = true;
    }
    if (!bracketed) {
      const double secant = low_slope < slope ? share * slope / (slope - low_slope) : 2.0 * share;
      if (trial > 1) return true;
      share = std::min({std::max(secant, 1.1 * share), 4.0 * share});
    } else if (std::isfinite(high_slope)) {
      const double across = low_slope / (low_slope - high_slope);
      share = low + std::min(std::max(across, 0.1), 0.9) * (high - low);
    } else {
      share = 0.5 * (low + high);
    }
    putBack(before_);
    move(way, share);
    here = workOf(way);
  }
  return low > 0.0 && std::isfinite(here);
}

template class CourseIn<float>;
template class CourseIn<double>;

}  // namespace robot_tissue
