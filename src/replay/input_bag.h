// A bag that is read: its transforms in the order in which they came. What is wrong with it is an
// InputError of one line that names the file.
#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <optional>
#include <string>

#include "robot_tissue/ros/transform_intake.h"

namespace robot_tissue {

class InputBag {
 public:
  explicit InputBag(const std::string& path);

  // A robot's description that was recorded on /robot_description.
  std::optional<std::string> robotDescription() const;
  // received: when the recorder had the message.
  using OnTransforms = std::function<void(const tf2_msgs::TFMessage& message,
                                          TransformIntake::Kind kind, const ros::Time& received)>;
  // At least one message.
  void forTransforms(const OnTransforms& on_transforms) const;

 private:
  [[noreturn]] void refuse(const std::string& why) const;

  std::string path_;
  rosbag::Bag bag_;
};

}  // namespace robot_tissue
