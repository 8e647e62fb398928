// Tissue: how it moves in time.
#include <algorithm>
#include <cmath>

#include "cutting/split_cells.h"
#include "material/elastic_model.h"
#include "solvers/solver_method.h"
#include "tissue/solve_total.h"
#include "tissue/threads.h"
#include "tissue/time_integrator.h"
#include "tissue/tissue_parts.h"
#include "tissue/tuning.h"

namespace robot_tissue {

bool TissueParts::goesThroughTime() const {
  return motion_.goesInTime() && methods_.now().goesThroughTimeSteps();
}

void TissueParts::beginTimeStep(double duration, Touched touched) {
  motion_.beginStep(duration, touched, methods_.now());
}

void TissueParts::endTimeStep() {
  const bool ends = motion_.isInTimeStep();
  motion_.leaveStep();
  if (!ends) return;
  const TimeIntegrator& integrator = motion_.integrator();
  const std::vector<const std::vector<int>*> falling = pieces_.falling();
  for (const std::vector<int>* nodes : falling) {
    shift(*nodes, -integrator.drift(*nodes, body_.state(), body_.gravity()));
  }
  motion_.end(methods_.now().velocities());
  if (!motion_.isMoving()) return;
  for (const std::vector<int>* nodes : falling) shift(*nodes, -integrator.lead(body_.gravity()));
}

void TissueParts::shift(const std::vector<int>& nodes, const Vec3& way) {
  if (way.isZero(0.0)) return;
  std::vector<Vec3>& displacement = body_.change().displacement;
  for (const int node : nodes) displacement[at(node)] += way;
  deformSurface();
}

// Loads or cuts are others, the shape is not yet.
SolveReport TissueParts::asItIs() {
  motion_.wake();
  outcome_.report.patches.resize(loads_.patches().size());
  return outcome_.report;
}

// Tools would have to be looked at on the way.
void TissueParts::predict() {
  LatticeState& state = body_.change();
  for (std::size_t node = 0; node < state.displacement.size(); ++node) {
    const int index = static_cast<int>(node);
    if (!isGone(state, index) && !isFixed(body_.lattice(), *state.cells, index)) {
      state.displacement[node] = motion_.integrator().predicted(node);
    }
  }
}

SolveReport TissueParts::wait(double duration) {
  if (motion_.isInTime() && !motion_.isMoving()) {
    outcome_.report.iterations = 0;
    outcome_.report.wall_ms = 0.0;
    return outcome_.report;
  }
  const TimeIntegrator& integrator = motion_.integrator();
  double left = duration;
  double longest = integrator.longestStep();
  SolveTotal total;
  while (left > 0.0) {
    const double steps = std::ceil(left / longest - tuning::kRounding);
    const double step = left / std::max(1.0, steps);
    const Shape good = shape();
    beginTimeStep(step, Touched::kByNone);
    if (loads_.patches().empty()) predict();
    const SolveReport report = solve({});
    endTimeStep();
    total.addWork(report);
    if (integrator.errorRatio() > tuning::kRefusedError && step > tuning::kShortestStep) {
      longest = std::max(tuning::kShortestStep, tuning::kMostShrink * step);
      restore(good);
      continue;
    }
    tear();
    longest = integrator.longestStep();
    total.worsen(report.status);
    left = steps > 1.0 ? left - step : 0.0;
    if (!motion_.isMoving()) break;
    if (bounds_.isTimeOver() && left > 0.0) {
      total.worsen(SolveStatus::kLate);
      break;
    }
  }
  total.tellIn(outcome_.report);
  return outcome_.report;
}

}  // namespace robot_tissue
