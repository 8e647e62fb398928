#include "robot_tissue/pipeline/wrench_prediction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "tuning.h"

namespace robot_tissue {

WrenchPrediction::WrenchPrediction(double arm, double max_force)
    : arm_(std::max(arm, tuning::kLeastArm)), max_force_(max_force) {}

void WrenchPrediction::forget() {
  touches_ = false;
  stiffness_.setZero();
  covariance_.setZero();
}

void WrenchPrediction::learn(const Pose& pose, const ToolWrench& solved) {
  const Vec6 wrench = stacked(solved);
  const Vec6 step = wayFrom(pose_, pose), change = wrench - wrench_;
  pose_ = pose;
  wrench_ = wrench;
  if (wrench_.isZero(0.0)) return forget();
  const double length = step.norm();
  const bool is_of_way = std::exchange(is_of_way_, true) && touches_;
  if (is_of_way && length > 0.0 && length < tuning::kFarthestLearned) learnStep(step, change);
  touches_ = true;
}

// What max_force leaves of a wrench tells nothing of the stiffness.
void WrenchPrediction::learnFrom(const Pose& reached, const ToolReport& report) {
  Pose pose = reached;
  pose.translation() -= report.offset;
  const Eigen::Matrix3d whole = reached.linear() / report.told_share;
  learn(pose, {whole * report.force_on_tool, whole * report.torque_on_tool});
}

// Where a wrench falls, as of tissue that slips, it is no more exact for being small: else the fall
// would be taken for a stiffness.
void WrenchPrediction::learnStep(const Vec6& step, const Vec6& change) {
  const double force = std::max(wrench_.norm(), change.norm());
  const double wander = force / tuning::kWayOfStiffness;
  covariance_.diagonal().array() += wander * wander * step.norm() / tuning::kWayOfStiffness;
  const double noise = tuning::kWrenchError * force;
  const Vec6 spread = covariance_ * step;
  const Vec6 gain = spread / (step.dot(spread) + 2.0 * noise * noise);
  stiffness_ += (change - stiffness_ * step) * gain.transpose();
  covariance_ -= gain * spread.transpose();
}

ToolWrench WrenchPrediction::at(const Pose& pose) const {
  if (!touches_) return {};
  Vec6 way = wayFrom(pose_, pose);
  if (way.norm() > tuning::kFarthestPredicted) way *= tuning::kFarthestPredicted / way.norm();
  Vec6 predicted = wrench_ + stiffness_ * way;
  const bool pulls = predicted.head<3>().dot(wrench_.head<3>()) < 0.0;
  if (pulls || !predicted.allFinite()) return {};
  const double force = predicted.head<3>().norm();
  if (max_force_ > 0.0 && force > max_force_) predicted *= max_force_ / force;
  return {predicted.head<3>(), arm_ * predicted.tail<3>()};
}

bool WrenchPrediction::foretells(const Pose& pose, double age_s) const {
  const bool is_near = wayFrom(pose_, pose).norm() <= tuning::kFarthestPredicted;
  return is_near && age_s <= tuning::kLongestPredicted;
}

WrenchPrediction::Vec6 WrenchPrediction::wayFrom(const Pose& from, const Pose& to) const {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Vec6 way;
  way << to.translation() - from.translation(), arm_ * turn.angle() * turn.axis();
  return way;
}

WrenchPrediction::Vec6 WrenchPrediction::stacked(const ToolWrench& wrench) const {
  Vec6 stacked;
  stacked << wrench.force, wrench.torque / arm_;
  return stacked;
}

}  // namespace robot_tissue
