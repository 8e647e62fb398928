#include "solvers/multigrid/cycle/earlier_ways.h"

#include <utility>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {

namespace tuning = cycle_tuning;

// Where it had no stiffness, nothing is conjugate to it.
template <typename Real>
void EarlierWays<Real>::add(const Place& from, const Place& to) {
  Way way = {to.shape, from.force, 0.0};
  way.step.add(from.shape, -1.0);
  way.loss.add(to.force, -1.0);
  way.work = workOf(way.loss, way.step);
  if (!(way.work > 0.0)) return;
  ways_.push_front(std::move(way));
  if (ways_.size() > tuning::kMostWays) ways_.pop_back();
}

// Were the forces linear, they would do no work along ways that were searched along, and the slope
// would stay as it is: where it falls, ways no longer fit.
template <typename Real>
double EarlierWays<Real>::join(const Vector& force, double slope, Vector& direction) {
  const double least = tuning::kLeastOfSlope * slope;
  for (auto way = ways_.begin(); way != ways_.end(); ++way) {
    const double share = -workOf(way->loss, direction) / way->work;
    const double after = slope + share * workOf(force, way->step);
    if (!(after >= least)) {
      ways_.erase(way, ways_.end());
      break;
    }
    direction.add(way->step, share);
    slope = after;
  }
  return slope;
}

template class EarlierWays<float>;
template class EarlierWays<double>;

}  // namespace robot_tissue
