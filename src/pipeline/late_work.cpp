// Pipeline: what a call has no time for, and how it is carried on.
#include <algorithm>
#include <cmath>

#include "robot_tissue/pipeline/pipeline.h"
#include "stopwatch.h"

namespace robot_tissue {
namespace {

constexpr int kMostLateIterations = 1500;  // where the tools stand: as many as a load step takes

}  // namespace

Pipeline::Bounded::Bounded(Pipeline& pipeline) : pipeline_(pipeline) {
  const std::optional<Deadline>& end = pipeline.end_;
  Deadline& deadline = pipeline.deadline_;
  deadline = Deadline(pipeline.budget_s_);
  if (end && end->leftMs() < deadline.leftMs()) deadline = *end;
  if (end || std::isfinite(pipeline.budget_s_)) pipeline.tissue_.setDeadline(deadline);
}

const StepReport& Pipeline::carryOn() {
  beginReport();
  if (!isLate()) return report_;
  const Bounded bounded(*this);
  if (tissue_.isLoading()) loadOn();
  finish();
  countLate();
  report_.late = isLate();
  report_.gave_up = gave_up_;
  return report_;
}

// A solve without a bound gives up, too.
void Pipeline::countLate() {
  late_iterations_ += tissue_.isLoading() ? 0 : std::max(1, tissue_.lastReport().iterations);
  gave_up_ = late_iterations_ > kMostLateIterations;
}

bool Pipeline::isLate() const {
  return tissue_.isLoading() || (!gave_up_ && (unfinished_ || tissue_.isLate()));
}

bool Pipeline::hasArrived() const {
  return last_pose_ && !isLate() && !report_.lost && toolsBehind().empty();
}

// Loads that there was no time for.
void Pipeline::loadOn() {
  const Stopwatch watch(report_.solve_ms);
  tissue_.loadOn([&](int, int, const SolveReport&) {
    contacts_.commit(pose_, tissue_);
    contacts_.ride(pose_, tissue_);
  });
  contacts_.commit(pose_, tissue_);
  report_.changed = true;
  checkpoints_.clear();
  if (last_pose_) checkIn(*last_pose_);
}

// What the last solve had no time for.
void Pipeline::finish() {
  unfinished_ = false;
  if (anyToolIn(tissue_.patches())) {
    report_.lost = !advance(last_pose_.value_or(pose_));
    if (report_.lost) report_.behind = toolsBehind();
  } else if (tissue_.isLate() && !tissue_.isLoading()) {
    const Stopwatch watch(report_.solve_ms);
    balance();
    contacts_.commit(pose_, tissue_);
    report_.changed = true;
  }
  describeTools();
}

}  // namespace robot_tissue
