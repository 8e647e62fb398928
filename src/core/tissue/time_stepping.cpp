#include "tissue/time_stepping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/split_cells.h"
#include "tissue/solve_total.h"
#include "tissue/tuning.h"

namespace robot_tissue {

void TimeStepping::beginTimeStep(double duration, Touched touched) {
  data_.motion.beginStep(duration, touched, data_.methods.now());
}

// A step that was cut short leaves a velocity that is none of the tissue's.
void TimeStepping::endTimeStep() {
  const bool ends = data_.motion.isInTimeStep();
  data_.motion.leaveStep();
  if (!ends) return;
  const TimeIntegrator& integrator = data_.motion.integrator();
  const std::vector<const std::vector<int>*> falling = data_.pieces.falling();
  for (const std::vector<int>* nodes : falling) {
    shift(*nodes, -integrator.drift(*nodes, data_.body.state(), data_.body.gravity()));
  }
  if (std::exchange(data_.outcome.is_cut_short, false)) {
    data_.motion.halt();
    if (!falling.empty()) data_.deformSurface();
    return;
  }
  data_.motion.end(data_.methods.now().velocities());
  if (data_.motion.isMoving()) {
    const Vec3 lead = integrator.lead(data_.body.gravity());
    for (const std::vector<int>* nodes : falling) shift(*nodes, -lead);
  }
  if (!falling.empty()) data_.deformSurface();
}

// The surface is to be deformed after it.
void TimeStepping::shift(const std::vector<int>& nodes, const Vec3& way) {
  if (way.isZero(0.0)) return;
  std::vector<Vec3>& displacement = data_.body.change().displacement;
  for (const int node : nodes) displacement[at(node)] += way;
}

// Tools would have to be looked at on the way.
void TimeStepping::predict() {
  LatticeState& state = data_.body.change();
  for (std::size_t node = 0; node < state.displacement.size(); ++node) {
    const int index = static_cast<int>(node);
    if (!isGone(state, index) && !isFixed(data_.body.lattice(), *state.cells, index)) {
      state.displacement[node] = data_.motion.integrator().predicted(node);
    }
  }
}

SolveReport TimeStepping::wait(double duration) {
  if (data_.motion.isInTime() && !data_.motion.isMoving()) {
    data_.outcome.report.iterations = 0;
    data_.outcome.report.wall_ms = 0.0;
    return data_.outcome.report;
  }
  const TimeIntegrator& integrator = data_.motion.integrator();
  double left = duration;
  double longest = integrator.longestStep();
  SolveTotal total;
  while (left > 0.0) {
    const double steps = std::ceil(left / longest - tuning::kRounding);
    const double step = left / std::max(1.0, steps);
    const Tissue::Shape good = data_.shape();
    beginTimeStep(step, Touched::kByNone);
    if (data_.loads.patches().empty()) predict();
    const SolveReport report = solver_.solve({});
    endTimeStep();
    total.addWork(report);
    if (integrator.isRefused()) {
      longest = std::max(tuning::kShortestStep, tuning::kMostShrink * step);
      data_.restore(good);
      continue;
    }
    surgery_.tear();
    longest = integrator.longestStep();
    total.worsen(report.status);
    left = steps > 1.0 ? left - step : 0.0;
    if (!data_.motion.isMoving()) break;
    if (data_.bounds.isTimeOver() && left > 0.0) {
      total.worsen(SolveStatus::kLate);
      break;
    }
  }
  total.tellIn(data_.outcome.report);
  return data_.outcome.report;
}

}  // namespace robot_tissue
