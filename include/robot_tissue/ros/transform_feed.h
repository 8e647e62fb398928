// Puts /tf and /tf_static into a buffer, in the thread that calls the queue. A transform stamped so
// far ahead that the buffer would drop all present ones for it is left out.
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>

#include <functional>

namespace robot_tissue {

class TransformFeed {
 public:
  // on_message: before each message of /tf is put in.
  TransformFeed(tf2_ros::Buffer& buffer, ros::CallbackQueueInterface& queue,
                std::function<void()> on_message);

 private:
  void take(const tf2_msgs::TFMessage& message, bool is_static);
  bool isAhead(const geometry_msgs::TransformStamped& transform) const;

  tf2_ros::Buffer& buffer_;
  std::function<void()> on_message_;
  ros::Subscriber moving_, static_;
};

}  // namespace robot_tissue
