#include "robot_tissue/ros/tissue_follower.h"

#include <ros/console.h>

#include <vector>

#include "robot_tissue/core/body_load.h"
#include "robot_tissue/pipeline/step_remarks.h"
#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {

TissueFollower::TissueFollower(const NodeParameters& parameters, Pipeline& pipeline)
    : parameters_(parameters),
      pipeline_(pipeline),
      clock_(1.0 / parameters.rate_hz, tuning::kLongestGap) {}

void TissueFollower::settleFromRest() {
  const Scene& scene = parameters_.scene;
  if (hasBodyLoad(scene.tissue) || !scene.supports.empty()) pipeline_.settle();
}

std::string TissueFollower::waitsAfterJump(const PoseLookUp& look_up) {
  const auto jumped = pipeline_.tissue().isUntouched() ? std::vector<std::size_t>()
                                                       : pipeline_.jumpsTo(look_up.pose);
  const ros::Time now = look_up.stamp;
  if (jumped.empty() || now < jumped_at_) jumped_at_ = ros::Time();
  if (jumped.empty()) return "";
  if (jumped_at_.isZero()) jumped_at_ = now;
  if (secondsBetween(jumped_at_, now) >= parameters_.tf_timeout_s) return "";
  return namesOf(jumped, pipeline_.tools()) +
         " jumped, farther than is followed: the last good shape stays, until the pose has lasted "
         "for " +
         numberText(parameters_.tf_timeout_s) + " s (~tf_timeout)";
}

const StepReport& TissueFollower::follow(PoseLookUp& look_up) {
  setTimeOf(look_up);
  return pipeline_.step(look_up.pose);
}

void TissueFollower::timeWentBack() {
  jumped_at_ = ros::Time();
  RobotPose nowhere;
  nowhere.stamp_s = clock_.now();
  pipeline_.step(nowhere);
}

void TissueFollower::setTimeOf(PoseLookUp& look_up) {
  const double reached = pipeline_.pose() ? pipeline_.pose()->stamp_s : clock_.now();
  look_up.pose.stamp_s = clock_.advance(look_up.stamp, pipeline_.tissue().isMoving(), reached);
  if (clock_.leftOut() > 0.0) {
    ROS_WARN_STREAM_THROTTLE(1.0, "no pose came for a while, or updates take longer than that: for "
                                      << secondsText(clock_.leftOut())
                                      << " s of it the tissue's time stood still");
  }
}

NodeStatus statusWithoutPose(const PoseLookUp& look_up) {
  const bool stale = look_up.status == PoseLookUp::Status::kStale;
  return {stale ? "STALE" : "NO_TRANSFORM", look_up.message};
}

}  // namespace robot_tissue
