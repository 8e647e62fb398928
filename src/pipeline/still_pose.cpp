#include "robot_tissue/pipeline/still_pose.h"

#include <cmath>

namespace robot_tissue {

double longestWay(const Pose& from, const Pose& to, double reach) {
  const double angle = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
  return (to.translation() - from.translation()).norm() + std::abs(angle) * reach;
}

bool StillPose::holds(const RobotPose& pose) const {
  if (pose.links.size() != pose_.links.size()) return false;
  for (std::size_t link = 0; link < pose.links.size(); ++link) {
    if (!(longestWay(pose_.links[link], pose.links[link], reach_[link]) <= most_)) return false;
  }
  return true;
}

}  // namespace robot_tissue
