// Calls back in the spinner's thread after transforms came: an update need not wait for the timer.
// Several that came meanwhile are one call.
#pragma once

#include <ros/callback_queue_interface.h>
#include <tf2_ros/buffer.h>

#include <functional>
#include <memory>

namespace robot_tissue {

class TransformWatch {
 public:
  // `queue` is the spinner's.
  TransformWatch(tf2_ros::Buffer& buffer, ros::CallbackQueueInterface& queue,
                 std::function<void()> on_transforms);
  ~TransformWatch();
  TransformWatch(const TransformWatch&) = delete;
  TransformWatch& operator=(const TransformWatch&) = delete;

 private:
  struct Wake;

  tf2_ros::Buffer& buffer_;
  ros::CallbackQueueInterface& queue_;
  std::shared_ptr<Wake> wake_;
  boost::signals2::connection connection_;
};

}  // namespace robot_tissue
