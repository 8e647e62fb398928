#include "tissue/load_stepping.h"

#include <algorithm>
#include <cmath>

#include "tissue/solve_total.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

// Longest way of a patch's node between these displacements (m).
double farthestWay(const std::vector<LoadRamp>& ramps, const std::vector<Vec3>& before,
                   const std::vector<Vec3>& now) {
  double farthest = 0.0;
  for (const LoadRamp& ramp : ramps) {
    for (const int node : ramp.target.nodes) {
      farthest = std::max(farthest, (now[at(node)] - before[at(node)]).norm());
    }
  }
  return farthest;
}

// Sets the patch to a share of its way. A patch by force stays where the solver moved it to.
void goAlong(const LoadRamp& ramp, double share, LoadingPatch& patch) {
  const auto between = [share](const Vec3& start, const Vec3& target) -> Vec3 {
    return share < 1.0 ? Vec3(start + share * (target - start)) : target;
  };
  patch.force = between(ramp.start.force, ramp.target.force);
  if (byForce(patch)) return;
  for (std::size_t i = 0; i < patch.displacement.size(); ++i) {
    patch.displacement[i] = between(ramp.start.displacement[i], ramp.target.displacement[i]);
  }
  for (RimSpring& spring : patch.rim) {
    const auto same = [&](const RimSpring& other) { return other.node == spring.node; };
    const auto start = std::find_if(ramp.start.rim.begin(), ramp.start.rim.end(), same);
    const auto target = std::find_if(ramp.target.rim.begin(), ramp.target.rim.end(), same);
    spring.anchor = between(start->anchor, target->anchor);
  }
}

}  // namespace

int wholeParts(double share) {
  return std::max(
      1, static_cast<int>(std::ceil(std::min(share, tuning::kMostSteps) - tuning::kRounding)));
}

// Out of time on the way of named patches: they stand there, and what they go to is due.
bool LoadStepping::stopsOnTheWay(const std::vector<LoadRamp>& ramps) {
  const bool named = std::all_of(ramps.begin(), ramps.end(), [&](const LoadRamp& ramp) {
    return ramp.patch < data_.loads.named();
  });
  if (!named || !data_.bounds.isTimeOver()) return false;
  for (const LoadRamp& ramp : ramps) data_.loads.makeDue(ramp.target);
  data_.outcome.worsen(SolveStatus::kLate);
  return true;
}

// Nothing converges any more, and there was work enough: the rest of the way is one step.
bool LoadStepping::isHopeless(const SolveReport& report) const {
  return report.status == SolveStatus::kUnconverged && data_.bounds.patience().cutsOff();
}

// How many of the method's longest steps s the load takes. A patch by displacement: its way over s.
// A patch by force: the force over k s, k the stiffness of the patch. In equilibrium a hard patch
// of n nodes answers like a flat punch, whose stiffness grows with its width, so as sqrt(n) nodes
// do (own); the paper's moves while the tissue around it stands, so all n nodes answer.
double LoadStepping::foreseenSteps(const std::vector<LoadRamp>& ramps) const {
  double steps = 1.0;
  for (const LoadRamp& ramp : ramps) {
    if (byForce(ramp.target)) {
      double sum = 0.0;
      for (const int node : ramp.target.nodes) sum += data_.body.nodeStiffness(node);
      const double nodes = static_cast<double>(ramp.target.nodes.size());
      const double stiffness =
          data_.methods.now().findsEquilibrium() ? sum / std::sqrt(nodes) : sum;
      const double force = (ramp.target.force - ramp.start.force).norm();
      if (stiffness > 0.0)
        steps = std::max(steps, force / (stiffness * data_.methods.now().patchStep()));
      continue;
    }
    for (std::size_t i = 0; i < ramp.target.nodes.size(); ++i) {
      Vec3 way = ramp.target.displacement[i] - ramp.start.displacement[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (ramp.target.free_axis[axis]) way[static_cast<Eigen::Index>(axis)] = 0.0;
      }
      steps = std::max(steps, way.norm() / data_.methods.now().patchStep());
    }
  }
  return std::min(steps, tuning::kMostSteps);
}

// With increments of its own choice. Those of a displacement are equal. Those of a force follow the
// stiffness that the last one met, so that the next moves its patch by one step, and one that went
// too far is made anew, where the method finds equilibria.
SolveReport LoadStepping::stepLoadsByItself(const std::vector<LoadRamp>& ramps,
                                            const Tissue::OnIncrement& on_increment) {
  const bool forced = std::any_of(ramps.begin(), ramps.end(),
                                  [](const LoadRamp& ramp) { return byForce(ramp.target); });
  if (!forced || !data_.methods.now().findsEquilibrium())
    return stepLoads(ramps, wholeParts(foreseenSteps(ramps)), on_increment);
  SolveReport report;
  SolveStatus worst = SolveStatus::kOk;
  const double first = 1.0 / foreseenSteps(ramps);
  const double least = std::max(tuning::kLeastOfFirst * first, 1.0 / tuning::kMostSteps);
  double share = 0.0, stride = first;
  for (int increment = 1; share < 1.0; ++increment) {
    const Tissue::Shape good = data_.shape();
    const double part = (1.0 - share) / wholeParts((1.0 - share) / stride);
    const double to = part < 1.0 - share ? share + part : 1.0;
    report = goTo(ramps, to);
    const double went = farthestWay(ramps, *good.displacement, data_.body.displacement()) /
                        data_.methods.now().patchStep();
    stride = std::max(least, part / std::max(went, 1.0 / tuning::kMostGrowth));
    const bool may_be_shorter = part > (1.0 + tuning::kRounding) * least;
    const bool has_time = !data_.bounds.isTimeOver() && !isHopeless(report);
    if (went > tuning::kTooFar && stride < part && may_be_shorter && has_time) {
      data_.restore(good);
      --increment;
      continue;
    }
    if (isHopeless(report)) stride = 1.0;
    share = to;
    report = surgery_.tear();
    worst = std::max(worst, report.status);
    const int left = share < 1.0 ? wholeParts((1.0 - share) / stride) : 0;
    if (on_increment) on_increment(increment, increment + left, report);
    if (share < 1.0 && stopsOnTheWay(ramps)) {
      worst = std::max(worst, SolveStatus::kLate);
      break;
    }
  }
  report.status = worst;
  return report;
}

SolveReport LoadStepping::stepLoads(const std::vector<LoadRamp>& ramps, int increments,
                                    const Tissue::OnIncrement& on_increment) {
  SolveReport report;
  SolveStatus worst = SolveStatus::kOk;
  for (int increment = 1; increment <= increments; ++increment) {
    const bool arrived = goInSteps(ramps, increment, increments, report);
    worst = std::max(worst, report.status);
    if (on_increment) on_increment(increment, increments, report);
    if (!arrived || (increment < increments && stopsOnTheWay(ramps))) {
      worst = std::max(worst, SolveStatus::kLate);
      break;
    }
  }
  report.status = worst;
  return report;
}

// An increment that would turn cells over, were only the patch to move, is walked in the method's
// own steps: in one go the shape would be that of no way there. False: time ran out before its end,
// and the rest is due.
bool LoadStepping::goInSteps(const std::vector<LoadRamp>& ramps, int increment, int increments,
                             SolveReport& report) {
  const double steps =
      data_.methods.now().findsEquilibrium() ? foreseenSteps(ramps) / increments : 1.0;
  const int parts = steps > tuning::kTooFar ? wholeParts(steps) : 1;
  report = SolveReport();
  for (int part = 1; part <= parts; ++part) {
    SolveTotal total(report);
    report = goTo(ramps, (increment - 1 + static_cast<double>(part) / parts) / increments);
    total.add(report);
    total.tellIn(report);
    data_.outcome.report = report;
    report = surgery_.tear();
    if (part < parts && stopsOnTheWay(ramps)) {
      report.status = data_.outcome.report.status;
      return false;
    }
    if (isHopeless(report)) part = std::max(part, parts - 1);
  }
  return true;
}

SolveReport LoadStepping::goTo(const std::vector<LoadRamp>& ramps, double share) {
  for (const LoadRamp& ramp : ramps) goAlong(ramp, share, data_.loads.patches()[ramp.patch]);
  return solver_.solve({});
}

}  // namespace robot_tissue
