#include "robot_tissue/ros/tool_poses.h"

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

// Stamps of static transforms, which hold at any time.
bool isStatic(const ros::Time& stamp) { return stamp.isZero(); }

}  // namespace

ToolPoses::ToolPoses(const tf2_ros::Buffer& buffer, std::string tissue_frame, double timeout_s)
    : buffer_(buffer), tissue_frame_(std::move(tissue_frame)), timeout_s_(timeout_s) {}

PoseLookUp ToolPoses::lookUp(const ros::Time& now) const {
  PoseLookUp found;
  try {
    ros::Time common;
    for (const std::string& link : links_) {
      const ros::Time newest =
          buffer_.lookupTransform(tissue_frame_, link, ros::Time(0)).header.stamp;
      if (isStatic(newest)) continue;
      common = isStatic(common) ? newest : std::min(common, newest);
    }
    for (const std::string& link : links_) {
      found.pose.tools.push_back(
          tf2::transformToEigen(buffer_.lookupTransform(tissue_frame_, link, common)));
    }
    found.stamp = isStatic(common) ? now : common;
    found.pose.stamp_s = found.stamp.toSec();
    found.age_s = (now - found.stamp).toSec();
  } catch (const tf2::TransformException& error) {
    found.message =
        std::string("no transform from a tool to '") + tissue_frame_ + "': " + error.what();
    return found;
  }
  if (found.age_s > timeout_s_) {
    found.status = PoseLookUp::Status::kStale;
    found.message = "the tools' pose is " + std::to_string(found.age_s) +
                    " s old; allowed: " + std::to_string(timeout_s_) + " (~tf_timeout)";
    return found;
  }
  if (found.age_s < -timeout_s_) {
    found.status = PoseLookUp::Status::kStale;
    found.message = "the tools' pose is " + std::to_string(-found.age_s) +
                    " s in the future; allowed: " + std::to_string(timeout_s_) + " (~tf_timeout)";
    return found;
  }
  found.status = PoseLookUp::Status::kOk;
  return found;
}

Pose ToolPoses::frame(const std::string& frame_id) const {
  if (frame_id.empty() || frame_id == tissue_frame_) return Pose::Identity();
  try {
    return tf2::transformToEigen(buffer_.lookupTransform(tissue_frame_, frame_id, ros::Time(0)));
  } catch (const tf2::TransformException& error) {
    throw InputError("header.frame_id: '" + frame_id + "' has no transform to '" + tissue_frame_ +
                     "'; allowed: a connected frame, or none (" + error.what() + ")");
  }
}

}  // namespace robot_tissue
