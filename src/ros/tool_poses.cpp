#include "robot_tissue/ros/tool_poses.h"

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>
#include <utility>

#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

// Stamps of static transforms, which hold at any time.
bool isStatic(const ros::Time& stamp) { return stamp.isZero(); }

// Of a buffer, which takes quaternions of a length within half a percent of 1, and no others.
Pose rigidPose(const geometry_msgs::TransformStamped& transform) {
  Pose pose = tf2::transformToEigen(transform);
  const auto& turn = transform.transform.rotation;
  pose.linear() =
      Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized().toRotationMatrix();
  return pose;
}

std::string staleText(const std::string& link, double age_s, double timeout_s) {
  return "the pose of link '" + link + "' is " + secondsText(std::abs(age_s)) + " s " +
         (age_s > 0.0 ? "old" : "in the future") + "; allowed: " + numberText(timeout_s) +
         " (~tf_timeout)";
}

}  // namespace

std::vector<std::string> linkFrames(const ToolGeometry& tool) {
  std::vector<std::string> frames;
  for (std::size_t link = 0; link < tool.links.size(); ++link) {
    const bool unnamed = tool.links[link].link.empty() && link + 1 < tool.links.size();
    frames.push_back(tool.links[unnamed ? link + 1 : link].link);
  }
  return frames;
}

std::vector<std::string> linkFrames(const std::vector<ToolGeometry>& tools) {
  std::vector<std::string> frames;
  for (const ToolGeometry& tool : tools) {
    const std::vector<std::string> own = linkFrames(tool);
    frames.insert(frames.end(), own.begin(), own.end());
  }
  return frames;
}

ToolPoses::ToolPoses(const tf2::BufferCore& buffer, std::string tissue_frame, double timeout_s)
    : buffer_(buffer), tissue_frame_(std::move(tissue_frame)), timeout_s_(timeout_s) {}

PoseLookUp ToolPoses::lookUp(const ros::Time& now) const {
  PoseLookUp found;
  std::string looked_up, oldest;
  try {
    ros::Time common;
    std::vector<geometry_msgs::TransformStamped> newest_of;
    for (const std::string& link : links_) {
      looked_up = link;
      newest_of.push_back(buffer_.lookupTransform(tissue_frame_, link, ros::Time(0)));
      const ros::Time newest = newest_of.back().header.stamp;
      if (isStatic(newest) || (!isStatic(common) && newest >= common)) continue;
      common = newest;
      oldest = link;
    }
    found.is_static = isStatic(common);
    found.stamp = found.is_static ? now : common;
    found.age_s = secondsBetween(found.stamp, now);
    if (std::abs(found.age_s) > timeout_s_) {
      found.status = PoseLookUp::Status::kStale;
      found.message = staleText(oldest, found.age_s, timeout_s_);
      return found;
    }
    for (std::size_t link = 0; link < links_.size(); ++link) {
      looked_up = links_[link];
      const ros::Time stamp = newest_of[link].header.stamp;
      if (stamp != common && !isStatic(stamp)) {
        newest_of[link] = buffer_.lookupTransform(tissue_frame_, looked_up, common);
      }
      found.pose.links.push_back(rigidPose(newest_of[link]));
    }
  } catch (const tf2::TransformException& error) {
    found.message = "no transform from link '" + looked_up + "' to '" + tissue_frame_ +
                    "': " + reasonText(error);
    return found;
  }
  found.pose.stamp_s = found.stamp.toSec();
  found.status = PoseLookUp::Status::kOk;
  return found;
}

std::optional<ToolPoses::Newest> ToolPoses::newest(const std::string& frame) const {
  try {
    const auto transform = buffer_.lookupTransform(tissue_frame_, frame, ros::Time(0));
    const ros::Time now = ros::Time::now();
    const ros::Time stamp = isStatic(transform.header.stamp) ? now : transform.header.stamp;
    if (std::abs(secondsBetween(stamp, now)) > timeout_s_) return std::nullopt;
    return Newest{rigidPose(transform), stamp};
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

Pose ToolPoses::frame(const std_msgs::Header& header) const {
  const std::string& frame = header.frame_id;
  if (frame.empty() || frame == tissue_frame_) return Pose::Identity();
  if (frame.front() == '/') {
    throw InputError("header.frame_id: '" + shortText(frame) +
                     "' begins with '/'; allowed: a frame of tf2, whose names do not");
  }
  try {
    const auto newest = buffer_.lookupTransform(tissue_frame_, frame, ros::Time(0));
    const double ahead = secondsBetween(newest.header.stamp, header.stamp);
    const bool is_asked = !header.stamp.isZero() && !isStatic(newest.header.stamp);
    if (is_asked && ahead > timeout_s_) {
      throw InputError("header.stamp: " + secondsText(ahead) +
                       " s after the newest transform of '" + shortText(frame) +
                       "'; allowed: at most " + numberText(timeout_s_) +
                       " (~tf_timeout), or 0: the newest");
    }
    const bool is_earlier = is_asked && ahead < 0.0;
    return rigidPose(is_earlier ? buffer_.lookupTransform(tissue_frame_, frame, header.stamp)
                                : newest);
  } catch (const tf2::ExtrapolationException& error) {
    throw InputError("header.stamp: '" + shortText(frame) +
                     "' has no transform of then; allowed: one that the buffer holds, or 0: the "
                     "newest (" +
                     shortText(reasonText(error)) + ")");
  } catch (const tf2::TransformException& error) {
    throw InputError("header.frame_id: '" + shortText(frame) + "' has no transform to '" +
                     tissue_frame_ + "'; allowed: a connected frame, or none (" +
                     shortText(reasonText(error)) + ")");
  }
}

}  // namespace robot_tissue
