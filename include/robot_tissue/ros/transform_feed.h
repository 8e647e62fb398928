// Puts /tf and /tf_static into a buffer (TransformIntake), in the thread that calls the queue.
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2/buffer_core.h>

#include <functional>
#include <string>

#include "robot_tissue/ros/transform_intake.h"

namespace robot_tissue {

class TransformFeed {
 public:
  // time_went_back: as TransformIntake's.
  TransformFeed(tf2::BufferCore& buffer, ros::CallbackQueueInterface& queue,
                std::function<bool()> time_went_back);
  // As TransformIntake's.
  std::string refused() const { return intake_.refused(); }

 private:
  TransformIntake intake_;
  ros::Subscriber moving_, static_;
};

}  // namespace robot_tissue
