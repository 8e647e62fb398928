#include "solvers/multigrid/cycle/warm_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

template <typename Real>
void WarmStart<Real>::noteStart() {
  if (!first_of_step_) return;
  CompositeVector<Real> now;
  shape_.keepPlaces(now);
  if (has_start_ && start_.nodes != now.nodes) {
    last_step_ = now;
    start_.groups.clear();
    last_step_.groups.clear();
    last_step_.add(start_, -1.0);
    has_step_ = true;
  }
  start_ = std::move(now);
  has_start_ = true;
}

template <typename Real>
bool WarmStart<Real>::take() {
  const bool is_due = first_of_step_ && has_step_;
  first_of_step_ = false;
  return is_due;
}

// Along the step, from share 0 to 1 or -1, the slope (the forces' work along it) goes from `slope`
// to `here`; were the energy quadratic, it would be zero at slope / (slope - here) times that.
template <typename Real>
bool WarmStart<Real>::go() {
  CompositeVector<Real>& undo = shape_.spare();
  shape_.keepPlaces(undo);
  last_step_.groups.assign(shape_.finest().constrained.groups.size(), GroupVector::Zero());
  const double slope = shape_.workOfForcesInPart(last_step_);
  if (slope == 0.0 || !std::isfinite(slope)) return false;
  const double share = slope > 0.0 ? 1.0 : -1.0;
  const double local = ended_late_ ? shape_.finest().squaredLocalMotion() : 0.0;
  shape_.move(last_step_, share);
  const double here = shape_.workOfForcesInPart(last_step_);
  if (std::abs(here) <= cycle_tuning::kFlatEnough * std::abs(slope)) return isGood(local, undo);
  const double best = slope / (slope - here);
  if (!std::isfinite(here) || !(best > 0.0)) {
    shape_.restore(undo);
    return false;
  }
  shape_.move(last_step_, share * (std::min(best, cycle_tuning::kFarthestWarmStart) - 1.0));
  return isGood(local, undo);
}

// A step that ended late also made up for what was left before, which is not to be gone on with.
// squared_local_before: the motion left to nodes alone before (GridLevel::squaredLocalMotion).
template <typename Real>
bool WarmStart<Real>::isGood(double squared_local_before, const CompositeVector<Real>& undo) {
  if (!ended_late_ || shape_.finest().squaredLocalMotion() <= squared_local_before) return true;
  shape_.restore(undo);
  return false;
}

template class WarmStart<float>;
template class WarmStart<double>;

}  // namespace robot_tissue
