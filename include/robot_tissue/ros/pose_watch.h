// Follows TF with no thread of its own: transforms go into the buffer, and the tools are looked up,
// in roscpp's thread that receives them. A pose at which nothing is to be done is answered there,
// so that a scene that stands wakes no other thread; another one is handed to the spinner's thread,
// the newest one when several came meanwhile.
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "robot_tissue/pipeline/still_pose.h"
#include "robot_tissue/ros/pose_pick.h"
#include "robot_tissue/ros/time_jumps.h"
#include "robot_tissue/ros/tool_poses.h"
#include "robot_tissue/ros/transform_feed.h"

namespace robot_tissue {

class PoseWatch {
 public:
  // Called with a good pose of tools that stand; in the receiving thread, with the watch locked.
  using OnStill = std::function<void(const ros::Time& stamp)>;
  // Called with a good pose that has a new stamp; in the thread of `queue`, the spinner's.
  using OnPose = std::function<void(PoseLookUp)>;

  // Poses are taken `rate_hz` times a second at most. `poses` and `queue` must outlive this.
  PoseWatch(tf2_ros::Buffer& buffer, const ToolPoses& poses, double rate_hz,
            ros::CallbackQueueInterface& queue, OnStill on_still, OnPose on_pose);
  ~PoseWatch();
  PoseWatch(const PoseWatch&) = delete;
  PoseWatch& operator=(const PoseWatch&) = delete;

  void setRate(double rate_hz);
  // From here on `poses` is asked: its links are known and stay.
  void start();
  // How many good poses came since this was last asked.
  struct Seen {
    bool any = false;
    ros::Time still;  // the newest stamp of a still one; zero when there was none
  };
  Seen seen();
  // The same stamp, for one who comes between.
  ros::Time newestStill();
  // Since then: poses that were due, and those of them that a newer one replaced.
  struct Counts {
    int came = 0;
    int missed = 0;
  };
  Counts counts();
  // Whether the rate leaves room to follow a pose that this did not hand over; then that takes it.
  bool takeTurn();
  // How often time has gone back so far, as where a bag plays again. What was received before goes.
  int timeJumps();
  // A transform of a frame that was left out, as it is none: which and why; else empty.
  std::string refusedTransform() const { return feed_->refused(); }
  // From here on these poses are answered as still ones; none: none is.
  void standAt(std::optional<StillPose> still);

 private:
  // Calls in the thread that receives.
  class AtOnce : public ros::CallbackQueueInterface {
   public:
    void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) override;
    void removeByID(std::uint64_t owner) override;
  };
  class HandOver;

  void noticeTime();
  void onTransforms();
  void handOver();

  tf2_ros::Buffer& buffer_;
  ros::CallbackQueueInterface& queue_;
  OnStill on_still_;
  OnPose on_pose_;
  std::mutex mutex_;  // of the members up to connection_
  PosePick pick_;
  bool started_ = false;
  Seen seen_;
  Counts counts_;
  TimeJumps time_;
  int time_jumps_ = 0;
  std::optional<StillPose> still_;
  std::optional<PoseLookUp> waiting_;  // for the spinner's thread
  boost::signals2::connection connection_;
  AtOnce at_once_;
  std::unique_ptr<TransformFeed> feed_;
};

}  // namespace robot_tissue
