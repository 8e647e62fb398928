// Tissue: how it moves in time.
#include <algorithm>
#include <cmath>

#include "material/elastic_model.h"
#include "robot_tissue/core/tissue.h"
#include "solvers/solver_method.h"
#include "tissue/time_integrator.h"
#include "tissue/tuning.h"

namespace robot_tissue {

bool Tissue::isMoving() const { return time_ && in_time_ && time_->moves(); }

double Tissue::longestTimeStep() const { return time_->longestStep(); }

// Whether loads that go and cuts leave the shape as it is, to be moved by time.
bool Tissue::takesNoTime() const { return time_ && !in_time_step_; }

void Tissue::beginTimeStep(double duration) {
  const auto& model = dynamic_cast<const ElasticModel&>(*model_);
  in_time_ = in_time_step_ = true;
  model_->setInertia(nullptr);
  const auto cell_forces = [&](const LatticeState& shape) {
    std::vector<Vec3> forces = method_->cellForces(shape);
    return forces.empty() ? model.cellForces(shape) : forces;
  };
  model_->setInertia(&time_->begin(duration, state_, model.nodeMasses(*state_.cells), cell_forces));
}

void Tissue::endTimeStep() {
  if (!in_time_step_) return;
  in_time_step_ = false;
  time_->end(state_);
}

void Tissue::stopTime() {
  if (!time_) return;
  in_time_ = in_time_step_ = false;
  time_->rest();
  model_->setInertia(nullptr);
}

// Loads or cuts are others, the shape is not yet.
SolveReport Tissue::asItIs() {
  in_time_ = true;
  time_->wake(state_);
  last_report_.patches.resize(patches_.size());
  return last_report_;
}

SolveReport Tissue::wait(double duration) {
  double left = duration;
  double longest = longestTimeStep();
  SolveStatus worst = SolveStatus::kOk;
  double wall_ms = 0.0;
  int iterations = 0;
  while (left > 0.0) {
    const double steps = std::ceil(left / longest - tuning::kRounding);
    const double step = left / std::max(1.0, steps);
    const Shape good = shape();
    beginTimeStep(step);
    const SolveReport report = solve(freeNodes());
    endTimeStep();
    wall_ms += report.wall_ms;
    iterations += report.iterations;
    if (time_->errorRatio() > tuning::kRefusedError && step > tuning::kShortestStep) {
      longest = std::max(tuning::kShortestStep, tuning::kMostShrink * step);
      restore(good);
      continue;
    }
    longest = longestTimeStep();
    worst = std::max(worst, report.status);
    left = steps > 1.0 ? left - step : 0.0;
    if (!time_->moves()) break;
    if (deadline_ && deadline_->isOver() && left > 0.0) {
      worst = std::max(worst, SolveStatus::kLate);
      break;
    }
  }
  last_report_.status = worst;
  last_report_.wall_ms = wall_ms;
  last_report_.iterations = iterations;
  return last_report_;
}

}  // namespace robot_tissue
