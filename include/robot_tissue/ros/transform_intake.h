// Puts messages of /tf and /tf_static into a buffer. A transform stamped so far ahead that the
// buffer would drop all present ones for it is left out, and warned about unless the clock soon
// comes there, too; one that the buffer has no place for any more is, in silence.
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace robot_tissue {

class TransformIntake {
 public:
  enum class Kind { kMoving, kStatic };

  // time_went_back: asked before a message is put in; the buffer is empty then.
  TransformIntake(tf2::BufferCore& buffer, std::function<bool()> time_went_back);

  // Of /tf or /tf_static, at ros::Time::now().
  void take(const tf2_msgs::TFMessage& message, Kind kind);
  // The last transform that is none, until its frame has a good one: which and why, one line; else
  // empty. In any thread.
  std::string refused() const;

 private:
  struct Ahead {
    std::string frame;
    ros::Time stamp;
    ros::SteadyTime seen;
  };

  void refuse(const geometry_msgs::TransformStamped& transform, const std::string& why);
  void put(const geometry_msgs::TransformStamped& transform, Kind kind);
  bool hasPlace(const geometry_msgs::TransformStamped& transform);
  bool isOfBefore(const ros::Time& now, const ros::Time& stamp) const;
  void warnOfAhead();

  tf2::BufferCore& buffer_;
  std::function<bool()> time_went_back_;
  std::map<std::string, ros::Time> newest_;  // stamps put in, by child frame
  std::optional<ros::Time> went_back_to_;    // the last time that time did
  std::optional<Ahead> ahead_;               // left out and not warned about yet
  ros::SteadyTime warned_;
  mutable std::mutex mutex_;  // of the members below
  std::string refused_frame_, refused_;
};

}  // namespace robot_tissue
