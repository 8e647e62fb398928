#include "solvers/multigrid/cycle/fas_cg_cycle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/multigrid/cycle/line_search.h"
#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

int rounded(double steps) { return static_cast<int>(std::lround(steps)); }

}  // namespace

template <typename Real>
void FasCgCycle<Real>::reset() {
  const double greatest = shape_.finest().greatestStiffness();
  steps_ = std::max(tuning::kFewestSteps, rounded(tuning::kStepsOfRoot * std::sqrt(greatest)));
}

// As a smaller part leaves vectors that were larger their room.
template <typename Real>
void FasCgCycle<Real>::noteOpened() {
  for (Vector* vector : {&start_, &force_, &direction_}) {
    *vector = Vector();
  }
  begin();
}

// Springs in contact are the stiffest of all, and begin and end: what is rough beside them lasts.
// Where tissue slips, the first cycle is all that a solve has.
template <typename Real>
int FasCgCycle<Real>::smootherSteps(const SolveContext& solve) const {
  const bool more = solve.in_contact && solve.cycles > 0;
  return more ? rounded(tuning::kMoreInContact * steps_) : steps_;
}

template <typename Real>
void FasCgCycle<Real>::begin() {
  fresh_ = true;
  conjugate_ = false;
  for (Vector* vector : {&force_before_, &direction_before_}) *vector = Vector();
}

template <typename Real>
void FasCgCycle<Real>::run(const SolveContext& solve, const MotionLeft& left) {
  startHere();
  const double longest = shape_.longestSmoothMotion();
  const double share = longest > longest_step_ ? longest_step_ / longest : 1.0;
  const int steps = smootherSteps(solve);
  if (share == 1.0 && isSteady(solve, left)) {
    if (solve.in_contact) {
      goFurther(steps);
    } else {
      shape_.correctAndSmooth(1.0, steps);
    }
    return begin();
  }
  shape_.keepForces(force_);
  shape_.correctAndSmooth(share, steps);
  shape_.keepPlaces(direction_);
  direction_.add(start_, -1.0);
  const bool slow = left.isAbove(tuning::kSlow);
  const double own_slope = workOf(force_, direction_);
  noteWay(solve);
  const double slope = fresh_ || !slow ? own_slope : joinEarlierWays(own_slope);
  conjugate_ = !fresh_ && slow;
  fresh_ = false;
  slope_before_ = own_slope;
  std::swap(force_before_, force_);
  if (own_slope > 0.0 && stepByLineSearch(slope)) {
    std::swap(direction_before_, direction_);
  } else {
    stepPlainly();
  }
}

// What slips, or hangs by little, a cycle leaves behind: where the forces at its end still work
// along it, it goes on, or back. By the forces in the open part alone: those in the
// uncovered part cost more than a look.
template <typename Real>
void FasCgCycle<Real>::goFurther(int steps) {
  shape_.keepForcesInPart(force_);
  shape_.correctAndSmooth(1.0, steps);
  shape_.keepPlaces(direction_);
  direction_.add(start_, -1.0);
  const double slope = workInPart(force_, direction_);
  const double here = shape_.workOfForcesInPart(direction_);
  SlopeBracket bracket(slope);
  if (!(slope > 0.0) || bracket.isFlat(here)) return;
  bracket.add(1.0, here);
  shape_.move(direction_, bracket.next(1.0) - 1.0);
}

// Where a part is open, cycles that get on are not searched along: the forces in the uncovered
// part, which the slope takes, cost more than the search gains. In contact they get on slower, as
// springs begin and end; not where a force moves a patch against them. Where all is open the first
// one, which may be all that a solve cut short has, is searched along.
template <typename Real>
bool FasCgCycle<Real>::isSteady(const SolveContext& solve, const MotionLeft& left) const {
  const auto& patches = solve.shape.patches;
  const bool slides = solve.in_contact && std::none_of(patches.begin(), patches.end(), byForce);
  const bool whole = shape_.levels().isWhole();
  if (solve.cycles == 0) return !whole;
  if (slides && solve.cycles < tuning::kCyclesAlone) return left.isAtMost(tuning::kSlowInContact);
  return !whole && left.isAtMost(tuning::kSlow);
}

// From the last cycle's start to this one's. In contact, where springs begin and end, the stiffness
// is another from cycle to cycle.
template <typename Real>
void FasCgCycle<Real>::noteWay(const SolveContext& solve) {
  if (fresh_) ways_.clear();
  if (!fresh_ && keeps_ways_) ways_.add({start_before_, force_before_}, {start_, force_});
  keeps_ways_ = !solve.in_contact && solve.cycles >= tuning::kLongSolve;
  if (keeps_ways_) start_before_ = start_;
}

template <typename Real>
double FasCgCycle<Real>::joinEarlierWays(double own_slope) {
  const double slope = ways_.join(force_, own_slope, direction_);
  if (ways_.isEmpty()) return joinLastDirection(own_slope);
  shape_.moveFrom(start_, direction_, 1.0);
  return slope;
}

// Goes on along the last direction, too, if the forces work along it. The slope there.
template <typename Real>
double FasCgCycle<Real>::joinLastDirection(double own_slope) {
  const double beta = (own_slope - workOf(force_before_, direction_)) / slope_before_;
  if (!(beta > tuning::kWorthKeeping)) return own_slope;
  const double along = workOf(force_, direction_before_);
  if (!(own_slope + beta * along > 0.0)) return own_slope;
  direction_.add(direction_before_, beta);
  shape_.moveFrom(start_, direction_, 1.0);
  return own_slope + beta * along;
}

// False: it leads nowhere.
template <typename Real>
bool FasCgCycle<Real>::stepByLineSearch(double slope) {
  return searchLine(slope, shape_.workOfForces(direction_), [this](double length) {
    shape_.moveFrom(start_, direction_, length);
    return shape_.workOfForces(direction_);
  });
}

// Where a cycle led nowhere. Steps of the smoother alone may lead astray, too, as where a light
// corner of a wall is about to snap through: they are gone as far as the forces work along them,
// and one step, D^-1 f, goes along the forces in any case. Nodes that are about to touch do not
// jump into what they touch.
template <typename Real>
void FasCgCycle<Real>::stepPlainly() {
  fresh_ = true;
  double& soon_touches = shape_.finest().constrained.soon_touches;
  soon_touches = tuning::kSoonTouches;
  bool went = false;
  for (const int steps : {tuning::kPlainSteps, 1}) {
    shape_.restore(start_);
    shape_.keepForces(force_);
    shape_.finest().smoothAndFindForces(steps);
    shape_.keepPlaces(direction_);
    direction_.add(start_, -1.0);
    const double slope = workOf(force_, direction_);
    went = slope > 0.0 && stepByLineSearch(slope);
    if (went) break;
  }
  soon_touches = 0.0;
  if (!went) smoothFrom(start_);
}

template <typename Real>
void FasCgCycle<Real>::smoothFrom(const Vector& places) {
  shape_.restore(places);
  shape_.finest().smoothAndFindForces(tuning::kPlainSteps);
  fresh_ = true;
}

template class FasCgCycle<float>;
template class FasCgCycle<double>;

}  // namespace robot_tissue
