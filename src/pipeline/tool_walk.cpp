// ToolMotion: one walk in load steps, of the strides that are whole, free, or shorter ones where no
// shape follows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "robot_tissue/pipeline/between.h"
#include "tool_motion.h"
#include "tuning.h"

namespace robot_tissue {

// Load steps of the way, or time steps, if these are more: whole ones, as a short one at the end
// would be one of high accelerations.
double ToolMotion::stepsOf(double load_steps, const RobotPose& start, const RobotPose& pose) const {
  const double duration = pose.stamp_s - start.stamp_s;
  if (!world_.tissue.hasTime() || !(duration > 0.0)) return load_steps;
  const double longest = std::max(world_.tissue.longestTimeStep(), tuning::kShortestTimeStep);
  return std::ceil(std::max(load_steps, duration / longest) - tuning::kTimeRounding);
}

namespace {

bool isFreeAndUnconverged(const World& world) {
  return isFree(world) && world.tissue.lastReport().status == SolveStatus::kUnconverged;
}

}  // namespace

// s; 0: no time passes.
double ToolMotion::stepDuration(double steps, const RobotPose& start, const RobotPose& pose) const {
  const double duration = pose.stamp_s - start.stamp_s;
  return world_.tissue.hasTime() && duration > 0.0 ? duration / steps : 0.0;
}

// From `start` to `pose`. Places on the way are counted in steps from its start.
class ToolMotion::Walk {
 public:
  Walk(ToolMotion& motion, const RobotPose& start, const RobotPose& pose);

  WalkEnd go();
  // How far it came.
  RobotPose came() const { return placeAt(gone_); }
  bool tookUnconverged() const { return took_unconverged_; }

 private:
  struct Stride {
    double end = 0.0;
    RobotPose pose;         // there
    bool is_last = false;   // it ends at the way's
    bool is_short = false;  // no longer than the shortest load step
  };

  RobotPose placeAt(double gone) const;
  Stride next() const;
  double length() const;
  double free() const;
  WalkEnd take(const Stride& stride);
  WalkEnd arriveAt(const Stride& stride, double before_ms);
  WalkEnd stopBefore(const Stride& stride);

  ToolMotion& motion_;
  World& world_;
  Patience& patience_;
  const RobotPose& start_;
  const RobotPose& pose_;
  double load_steps_;     // of the way
  double steps_;          // load steps of the way, or time steps, if these are more
  double step_s_;         // s, of a step; 0: no time passes
  double end_;            // what is beyond is rounding
  double gone_ = 0.0;     // so far
  double longest_ = 1.0;  // next stride, where the way is not free
  double longest_s_ = std::numeric_limits<double>::infinity();  // likewise, in time
  bool took_unconverged_ = false;  // a stride whose shape nothing touched
  int in_short_ones_ = 0;          // iterations, in load steps that were not whole
};

ToolMotion::Walk::Walk(ToolMotion& motion, const RobotPose& start, const RobotPose& pose)
    : motion_(motion),
      world_(motion.world_),
      patience_(world_.tissue.patience()),
      start_(start),
      pose_(pose),
      load_steps_(motion.ways_.stepsBetween(start, pose)),
      steps_(motion.stepsOf(load_steps_, start, pose)),
      step_s_(motion.stepDuration(steps_, start, pose)),
      // Rigid patches find the shapes that they left by the steps of their ways, as these were.
      end_(world_.tools.anyRigid() ? steps_ : steps_ - tuning::kWayRounding) {
  if (std::exchange(motion.behind_.begins_short, false)) longest_ = tuning::kShortestStep;
  patience_.forgetWay();
}

ToolMotion::WalkEnd ToolMotion::Walk::go() {
  if (end_ <= 0.0) {
    const bool stays = motion_.load_step_.advance(pose_) == LoadStepEnd::kArrived;
    return stays ? WalkEnd::kArrived : WalkEnd::kLostAtEnd;
  }
  WalkEnd end = WalkEnd::kGoesOn;
  while (end == WalkEnd::kGoesOn) end = take(next());
  return end;
}

RobotPose ToolMotion::Walk::placeAt(double gone) const {
  return gone > 0.0 ? between(start_, pose_, gone / steps_) : start_;
}

ToolMotion::Walk::Stride ToolMotion::Walk::next() const {
  const double length = this->length();
  Stride stride;
  stride.is_last = gone_ + length >= end_;
  stride.end = stride.is_last ? steps_ : gone_ + length;
  stride.pose = stride.is_last ? pose_ : between(start_, pose_, stride.end / steps_);
  stride.is_short = std::min(longest_, stride.end - gone_) <= tuning::kShortestStep;
  return stride;
}

// In time, strides are parts of what is left that are alike. Where nothing is near, they are as
// long as the error allows, as of Tissue::wait; but a tool goes no farther than a load step.
double ToolMotion::Walk::length() const {
  const bool moves = step_s_ > 0.0 && world_.tissue.isMoving();
  if (!moves || longest_ < 1.0) return std::max(longest_, free());
  const double left = steps_ - gone_;
  double parts = left;
  double longest_s = longest_s_;
  if (isFree(world_)) {
    parts = left * load_steps_ / steps_;
    longest_s = std::min(longest_s, world_.tissue.longestTimeStep());
  }
  parts = std::max(parts, left * step_s_ / longest_s);
  return left / std::max(1.0, std::ceil(parts - tuning::kTimeRounding));
}

// Steps before any tool can touch. Whole ones in time, too: what is left at the end would be short.
double ToolMotion::Walk::free() const {
  if (!(load_steps_ > 0.0) || world_.tissue.isMoving()) return 0.0;
  const double free = motion_.ways_.freeSteps(came(), pose_) * (steps_ / load_steps_);
  return world_.tissue.hasTime() ? std::floor(free) : free;
}

ToolMotion::WalkEnd ToolMotion::Walk::take(const Stride& stride) {
  const double before_ms = world_.deadline.leftMs();
  const auto if_unconverged = stride.is_short ? IfUnconverged::kTake : IfUnconverged::kRefuse;
  const LoadStepEnd end = motion_.load_step_.advance(stride.pose, if_unconverged);
  if (end == LoadStepEnd::kArrived) return arriveAt(stride, before_ms);
  if (end == LoadStepEnd::kUnderWay) return WalkEnd::kUnderWay;
  if (end == LoadStepEnd::kTooLong) {
    longest_ = 1.0;
    longest_s_ = tuning::kShorterTimeStep * step_s_ * (stride.end - gone_);
    return WalkEnd::kGoesOn;  // whatever time is left: the next update would try the same
  }
  if (stride.is_short || patience_.isOver()) return stopBefore(stride);
  longest_ = tuning::kShortestStep;
  const bool has_time = end == LoadStepEnd::kNoShape && !motion_.isShort(before_ms);
  return has_time && !motion_.isBounded() ? WalkEnd::kGoesOn : WalkEnd::kToBeginShort;
}

ToolMotion::WalkEnd ToolMotion::Walk::arriveAt(const Stride& stride, double before_ms) {
  if (longest_ == 1.0) patience_.forgetWay();
  gone_ = stride.end;
  if (longest_ < 1.0) in_short_ones_ += world_.tissue.lastReport().iterations;
  longest_ = std::min(1.0, 2.0 * longest_);
  longest_s_ = isFree(world_) ? tuning::kLongerTimeStep * longest_s_
                              : std::numeric_limits<double>::infinity();
  took_unconverged_ = took_unconverged_ || isFreeAndUnconverged(world_);
  if (stride.is_last) return WalkEnd::kArrived;
  if (world_.tools.anyRigid()) motion_.checkIn(stride.pose);
  if (patience_.cutsOff()) return WalkEnd::kCutOff;
  const bool is_over = motion_.isShort(before_ms) ||
                       (motion_.isBounded() && in_short_ones_ >= world_.mostIterations());
  return is_over ? WalkEnd::kOutOfTime : WalkEnd::kGoesOn;
}

// The shortest load step from here is one that no shape follows.
ToolMotion::WalkEnd ToolMotion::Walk::stopBefore(const Stride& stride) {
  const double next = std::min(gone_ + tuning::kShortestStep, stride.end);
  world_.dead_end =
      DeadEnd{came(), stride.is_short ? stride.pose : between(start_, pose_, next / steps_)};
  return WalkEnd::kDeadEnd;
}

// The walk itself. Returns how far it came.
RobotPose ToolMotion::walkFrom(const RobotPose& start, const RobotPose& pose) {
  Walk walk(*this, start, pose);
  const WalkEnd end = walk.go();
  if (walk.tookUnconverged()) world_.tissue.noteUnconverged();
  note(end);
  if (end != WalkEnd::kArrived && end != WalkEnd::kLostAtEnd) return walk.came();
  if (world_.tools.anyRigid() && world_.tissue.isUntouched()) checkIn(pose);
  return pose;
}

// What the report, and the next update, have of how a walk ended.
void ToolMotion::note(WalkEnd end) {
  StepReport& report = world_.report;
  switch (end) {
    case WalkEnd::kGoesOn:
    case WalkEnd::kArrived:
      return;
    case WalkEnd::kOutOfTime:
    case WalkEnd::kUnderWay:
      report.too_fast = true;
      return;
    case WalkEnd::kToBeginShort:
      report.too_fast = true;
      behind_.begins_short = true;
      return;
    case WalkEnd::kDeadEnd:
      world_.tissue.haltMotion();  // else the next update would go the same way
      report.lost = true;
      return;
    case WalkEnd::kCutOff:
    case WalkEnd::kLostAtEnd:
      report.lost = true;
      return;
  }
}

}  // namespace robot_tissue
