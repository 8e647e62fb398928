#include "robot_tissue/pipeline/between.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace robot_tissue {

Pose between(const Pose& from, const Pose& to, double share) {
  if (share <= 0.0) return from;
  if (share >= 1.0) return to;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(from.linear())
                      .slerp(share, Eigen::Quaterniond(to.linear()))
                      .toRotationMatrix();
  pose.translation() = from.translation() + share * (to.translation() - from.translation());
  return pose;
}

RobotPose between(const RobotPose& from, const RobotPose& to, double share) {
  RobotPose pose = to;
  pose.stamp_s = from.stamp_s + share * (to.stamp_s - from.stamp_s);
  for (std::size_t link = 0; link < to.links.size(); ++link) {
    pose.links[link] = between(from.links[link], to.links[link], share);
  }
  return pose;
}

}  // namespace robot_tissue
