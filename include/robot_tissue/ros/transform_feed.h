// Puts /tf and /tf_static into a buffer, in the thread that calls the queue. A transform stamped so
// far ahead that the buffer would drop all present ones for it is left out, and warned about unless
// the clock soon comes there, too; one that the buffer has no place for any more is, in silence.
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace robot_tissue {

class TransformFeed {
 public:
  // time_went_back: asked before a message is put in; the buffer is empty then.
  TransformFeed(tf2_ros::Buffer& buffer, ros::CallbackQueueInterface& queue,
                std::function<bool()> time_went_back);

 private:
  enum class Kind { kMoving, kStatic };
  struct Ahead {
    std::string frame;
    ros::Time stamp;
    ros::WallTime seen;
  };

  void take(const tf2_msgs::TFMessage& message, Kind kind);
  bool hasPlace(const geometry_msgs::TransformStamped& transform);
  void warnOfAhead();

  tf2_ros::Buffer& buffer_;
  std::function<bool()> time_went_back_;
  std::map<std::string, ros::Time> newest_;  // stamps put in, by child frame
  std::optional<Ahead> ahead_;               // left out and not warned about yet
  ros::WallTime warned_;
  ros::Subscriber moving_, static_;
};

}  // namespace robot_tissue
