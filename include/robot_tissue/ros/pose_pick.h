// Which of the poses that come are followed: good ones with a new stamp, so many times a second at
// most.
#pragma once

#include <ros/time.h>

#include <optional>

#include "robot_tissue/ros/tool_poses.h"
#include "robot_tissue/ros/update_pace.h"

namespace robot_tissue {

class PosePick {
 public:
  // The poses must outlive it.
  PosePick(const ToolPoses& poses, double rate_hz) : poses_(poses), pace_(rate_hz) {}

  void setRate(double rate_hz) { pace_ = UpdatePace(rate_hz); }
  // Stamps of before say nothing any more.
  void timeWentBack() { last_stamp_ = ros::Time(); }
  // Whether a pose may be followed now that did not come just now; then it counts as one that did.
  bool takeTurn(const ros::Time& now) {
    const bool is_due = pace_.isDue(now.toSec());
    if (is_due) pace_.take(now.toSec());
    return is_due;
  }
  // After transforms came: the pose to be followed, if there is one. Where all transforms are
  // static none is.
  std::optional<PoseLookUp> take(const ros::Time& now) {
    if (!pace_.isDue(now.toSec())) return std::nullopt;
    PoseLookUp look_up = poses_.lookUp(now);
    const bool is_good = look_up.status == PoseLookUp::Status::kOk && !look_up.is_static;
    if (!is_good || look_up.stamp == last_stamp_) return std::nullopt;
    pace_.take(now.toSec());
    last_stamp_ = look_up.stamp;
    return look_up;
  }

 private:
  const ToolPoses& poses_;
  UpdatePace pace_;
  ros::Time last_stamp_;
};

}  // namespace robot_tissue
