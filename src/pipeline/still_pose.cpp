#include "robot_tissue/pipeline/still_pose.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {

double longestWay(const Pose& from, const Pose& to, double reach) {
  const double angle = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
  return (to.translation() - from.translation()).norm() + std::abs(angle) * reach;
}

// In shares of the way a point has the velocity shift + R (turn x point), with R from that of one
// end to that of the other: at most half of the angle from the nearer one. Its length is convex in
// the point, and so greatest in a corner.
double longestWay(const Pose& from, const Pose& to, const std::vector<Vec3>& corners) {
  const Eigen::AngleAxisd rotation(from.linear().transpose() * to.linear());
  const Vec3 turn = rotation.angle() * rotation.axis();
  const Vec3 shift = to.translation() - from.translation();
  if (corners.empty()) return shift.norm();
  double by_ends = 0.0, by_turn = 0.0;
  for (const Vec3& corner : corners) {
    const Vec3 around = turn.cross(corner);
    const double at_from = (shift + from.linear() * around).norm();
    const double at_to = (shift + to.linear() * around).norm();
    const double off_ends = 0.5 * std::abs(rotation.angle()) * around.norm();
    by_ends = std::max(by_ends, std::max(at_from, at_to) + off_ends);
    by_turn = std::max(by_turn, around.norm());
  }
  return std::min(by_ends, shift.norm() + by_turn);
}

bool StillPose::holds(const RobotPose& pose) const {
  if (pose.links.size() != pose_.links.size()) return false;
  for (std::size_t link = 0; link < pose.links.size(); ++link) {
    if (!(longestWay(pose_.links[link], pose.links[link], reach_[link]) <= most_)) return false;
  }
  return true;
}

}  // namespace robot_tissue
