// The node: reads the robot's pose, steps the pipeline, publishes, answers services. It holds no
// mechanics. Everything runs in one thread, the spinner's, but for poses at which nothing is to be
// done (PoseWatch) and wrenches with a rate of their own (WrenchPublisher). A new pose is followed
// as soon as it came, `~rate` times a second at most. Where none comes the timer goes on at that
// rate with what is left to do; else it only watches, seldom, but never as seldom as a low rate.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <ros/timer.h>
#include <tf2_ros/buffer.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/pipeline/step_remarks.h"
#include "robot_tissue/ros/live_parameters.h"
#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/pose_watch.h"
#include "robot_tissue/ros/surgery_services.h"
#include "robot_tissue/ros/tissue_follower.h"
#include "robot_tissue/ros/tissue_publisher.h"
#include "robot_tissue/ros/tissue_services.h"
#include "robot_tissue/ros/tool_poses.h"

namespace robot_tissue {

class TissueNode {
 public:
  // Throws InputError on a wrong parameter or robot description. A missing robot description is
  // waited for.
  explicit TissueNode(const ros::NodeHandle& private_node);

 private:
  enum class Ticks { kAtRate, kSeldom };  // of the timer

  void settleFromRest();
  void onStill(const ros::Time& stamp);
  void onTimer();
  void onSteadyTimer();
  void tick(Ticks ticks);
  ros::Duration period() const;
  void retune(const NodeParameters& wanted);
  void wake();
  bool timeWentBack();
  void standUntil(const ros::Time& stamp);
  void tellStill(const ros::Time& stamp);
  bool isStill() const;
  void update(PoseLookUp look_up);
  bool waitsAfterJump();
  void follow();
  bool robotIsKnown();
  void report(const NodeStatus& status,
              TissuePublisher::Wrenches wrenches = TissuePublisher::Wrenches::kNone);
  void giveBackMemory();
  // node_status.cpp
  void addDiagnostics();
  void remember(const std::vector<StepRemark>& remarks);
  void diagnoseRate(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseTransforms(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseTools(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseSolver(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle private_node_;
  NodeParameters parameters_;
  Pipeline pipeline_;
  tf2_ros::Buffer buffer_;
  ToolPoses tool_poses_;
  TissuePublisher publisher_;
  TissueFollower follower_;
  bool robot_is_known_ = false;
  ros::SteadyTime next_robot_look_up_;
  PoseLookUp last_look_up_;
  Ticks ticks_ = Ticks::kAtRate;
  NodeStatus status_;
  ros::SteadyTime grace_end_;  // until then it is no fault that no pose is there yet
  std::string warned_;         // status that was warned about last, until there is a good pose
  int time_jumps_ = 0;
  std::map<StepRemark::Kind, std::string> tools_said_;  // since the diagnostics were last told
  bool was_late_ = false;                               // likewise
  ros::SteadyTime rate_told_;
  std::uint64_t tidy_revision_ = 0;  // of the surface, when memory was given back last
  ros::SteadyTime tidied_;           // that time
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<TissueServices> services_;
  std::unique_ptr<SurgeryServices> surgery_;
  std::unique_ptr<LiveParameters> live_;
  ros::Timer timer_;
  ros::SteadyTimer steady_timer_;  // in simulated time, until there is some
  PoseWatch watch_;                // the first to go: it calls into the others
};

}  // namespace robot_tissue
