// Pipeline: what a call has no time for, and how it is carried on.
#include <algorithm>
#include <cmath>

#include "pipeline_parts.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {

Pipeline::Bounded::Bounded(Pipeline& pipeline) : pipeline_(pipeline) {
  const std::optional<Deadline>& end = pipeline.end_;
  World& world = pipeline.world_;
  world.deadline = Deadline(pipeline.budget_s_ - 1e-3 * pipeline.state_.reporting_ms);
  if (end && end->leftMs() <= world.deadline.leftMs()) world.deadline = *end;
  if (end || std::isfinite(pipeline.budget_s_)) world.tissue.setDeadline(world.deadline);
}

Pipeline::Bounded::~Bounded() { pipeline_.world_.tissue.setDeadline(pipeline_.end_); }

const StepReport& Pipeline::carryOn() {
  beginReport(true);
  if (!isLate()) return world_.report;
  world_.tools_move = false;
  const Bounded bounded(*this);
  if (world_.tissue.isLoading()) loadOn();
  finish();
  countLate();
  return endReport();
}

// Counts the iterations since the tools stand; a solve that never converges is given up in the end,
// with a budget or without.
void Pipeline::countLate() {
  state_.late_iterations +=
      world_.tissue.isLoading() ? 0 : std::max(1, world_.tissue.lastReport().iterations);
  state_.gave_up = state_.late_iterations > tuning::kMostLateIterations;
}

void Pipeline::setMostIterations(int iterations) { world_.most_iterations = iterations; }

bool Pipeline::isBehind() const {
  return world_.tissue.isLoading() ||
         (!state_.gave_up && (world_.unfinished || world_.tissue.isLate()));
}

bool Pipeline::isLate() const {
  return isBehind() || (!state_.gave_up && !world_.tissue.areContactsSettled());
}

bool Pipeline::hasArrived() const {
  return world_.last_pose && !isBehind() && !world_.report.lost &&
         parts_->motion.toolsBehind().empty();
}

// What the last solve had no time for.
void Pipeline::finish() {
  world_.unfinished = false;
  const bool is_open = world_.tissue.isLate() || !world_.tissue.areContactsSettled();
  if (anyToolIn(world_.tissue.patches(), world_)) {
    const LoadStepEnd end = parts_->motion.finishStanding();
    const bool is_under_way = end == LoadStepEnd::kUnderWay;
    if (end != LoadStepEnd::kArrived && !is_under_way) world_.report.lost = true;
    world_.unfinished = world_.unfinished || is_under_way;
    if (world_.report.lost) world_.report.behind = parts_->motion.toolsBehind();
  } else if (is_open && !world_.tissue.isLoading()) {
    const Stopwatch watch(world_.report.solve_ms);
    parts_->load_step.balance();
    world_.sliding.commit(world_.pose, world_.tissue);
    world_.report.changed = true;
  }
  describeTools();
}

// Loads that there was no time for.
void Pipeline::loadOn() {
  const Stopwatch watch(world_.report.solve_ms);
  parts_->load_step.forgetUnderWay();  // begun with less of them
  world_.tissue.loadOn([&](int, int, const SolveReport&) {
    world_.sliding.commit(world_.pose, world_.tissue);
    world_.sliding.ride(world_.pose, world_.tissue);
  });
  world_.sliding.commit(world_.pose, world_.tissue);
  world_.report.changed = true;
  parts_->motion.checkInAnew();
}

}  // namespace robot_tissue
