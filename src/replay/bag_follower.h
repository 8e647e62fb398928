// What the node does with transforms, without its master: by the same classes the poses are picked,
// the tissue follows, and what is told of it goes into a bag. Time is that of the messages; no
// update is cut short by the machine's.
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "output_bag.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/pose_pick.h"
#include "robot_tissue/ros/tissue_follower.h"
#include "robot_tissue/ros/tool_poses.h"
#include "robot_tissue/ros/transform_intake.h"

namespace robot_tissue {

class BagFollower {
 public:
  struct Shape {
    bool surface = false;
    bool nodes = false;
  };

  // What is handed in must outlive it. before_look: called before each look for a pose where none
  // comes; what it throws ends take(). Throws InputError.
  BagFollower(const NodeParameters& parameters, const std::vector<ToolGeometry>& tools, Shape shape,
              OutputBag& out, std::function<void()> before_look);
  ~BagFollower();
  BagFollower(const BagFollower&) = delete;
  BagFollower& operator=(const BagFollower&) = delete;

  // Times do not go back.
  void take(const tf2_msgs::TFMessage& message, TransformIntake::Kind kind,
            const ros::Time& received);

  int posesFollowed() const { return poses_followed_; }
  // Of the last pose, or why it was none.
  const NodeStatus& status() const { return status_; }
  std::uint64_t stateHash() const { return pipeline_.tissue().stateHash(); }
  const std::vector<std::string>& toolWarnings() const { return pipeline_.toolWarnings(); }

 private:
  void watchUntil(const ros::Time& now);
  void onTransforms();
  void update(PoseLookUp look_up, const ros::Time& now);
  void tell(const PoseLookUp& look_up);
  void tellWrenches(const ros::Time& stamp);
  void tellShape(const ros::Time& stamp);
  void tellState(const ros::Time& stamp, double age_s);
  void tellFault(const NodeStatus& status, const ros::Time& now);

  const NodeParameters& parameters_;
  Shape shape_;
  OutputBag& out_;
  std::function<void()> before_look_;
  Pipeline pipeline_;
  tf2::BufferCore buffer_;
  ToolPoses poses_;
  PosePick pick_;
  TransformIntake intake_;
  TissueFollower follower_;
  boost::signals2::connection connection_;
  std::vector<std::string> tool_frames_;  // of the wrenches
  NodeStatus status_;
  int poses_followed_ = 0;
  bool any_pose_ = false;  // since the last look of the watch
  bool shape_is_told_ = false;
  ros::Time next_watch_, last_fault_;
};

}  // namespace robot_tissue
