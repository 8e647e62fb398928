// Where the tools are, from TF: every link of every tool at one common stamp, in the tissue's
// frame.
#pragma once

#include <ros/time.h>
#include <std_msgs/Header.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/robot_pose.h"

namespace robot_tissue {

struct PoseLookUp {
  enum class Status { kOk, kNoTransform, kStale };
  Status status = Status::kNoTransform;
  std::string message;     // one line, empty when OK
  RobotPose pose;          // only when OK
  ros::Time stamp;         // of the pose; now when every transform is static
  bool is_static = false;  // every transform is
  double age_s = 0.0;
};

// The frames of a tool's links; a grasper's own link without a name stands where its first jaw is.
// The first one is the tool's frame.
std::vector<std::string> linkFrames(const ToolGeometry& tool);

// Of all tools, one after the other, as RobotPose::links has them.
std::vector<std::string> linkFrames(const std::vector<ToolGeometry>& tools);

class ToolPoses {
 public:
  ToolPoses(const tf2::BufferCore& buffer, std::string tissue_frame, double timeout_s);

  // In the order of RobotPose::links.
  void setLinks(const std::vector<std::string>& links) { links_ = links; }
  PoseLookUp lookUp(const ros::Time& now) const;
  // Of one frame at its newest stamp, which is now where it is static; none where there is no
  // transform, or an old one. In any thread.
  struct Newest {
    Pose tissue_T_frame;
    ros::Time stamp;
  };
  std::optional<Newest> newest(const std::string& frame) const;
  // tissue_T_frame at the header's stamp; at the newest one where that is zero, or newer by no more
  // than the timeout. Throws InputError where there is none.
  Pose frame(const std_msgs::Header& header) const;

 private:
  const tf2::BufferCore& buffer_;
  std::string tissue_frame_;
  double timeout_s_;
  std::vector<std::string> links_;
};

}  // namespace robot_tissue
