// The tissue follows the tools' poses: what the node does at each, and `replay` at those of a bag.
#pragma once

#include <ros/time.h>

#include <string>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/node_status.h"
#include "robot_tissue/ros/tissue_clock.h"
#include "robot_tissue/ros/tool_poses.h"

namespace robot_tissue {

class TissueFollower {
 public:
  // The arguments must outlive it.
  TissueFollower(const NodeParameters& parameters, Pipeline& pipeline);

  // Balances the tissue under what acts without tools: gravity, pressure and supports.
  void settleFromRest();
  // A good pose that tools jumped to, farther than is followed, may be a wrong one: while tools
  // touch, it has to last before the good shape is given up for it. What is said then; empty: the
  // pose is to be followed.
  std::string waitsAfterJump(const PoseLookUp& look_up);
  // At a good pose, whose time becomes the tissue's.
  const StepReport& follow(PoseLookUp& look_up);
  // The tools are nowhere until their next pose.
  void timeWentBack();

 private:
  void setTimeOf(PoseLookUp& look_up);

  const NodeParameters& parameters_;
  Pipeline& pipeline_;
  TissueClock clock_;
  ros::Time jumped_at_;  // stamp of the first pose after a jump that is not followed yet
};

// What is wrong where a pose is not good.
NodeStatus statusWithoutPose(const PoseLookUp& look_up);

}  // namespace robot_tissue
