#include "robot_tissue/ros/transform_feed.h"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <utility>

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr unsigned kQueue = 100;      // messages, as tf2_ros has it
constexpr double kWarnPeriod = 10.0;  // s

}  // namespace

TransformFeed::TransformFeed(tf2_ros::Buffer& buffer, ros::CallbackQueueInterface& queue,
                             std::function<void()> on_message)
    : buffer_(buffer), on_message_(std::move(on_message)) {
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  const auto subscribe = [&](const char* topic, bool is_static) {
    const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> take =
        [this, is_static](const tf2_msgs::TFMessageConstPtr& message) {
          this->take(*message, is_static);
        };
    return node.subscribe<tf2_msgs::TFMessage>(topic, kQueue, take, ros::VoidConstPtr(),
                                               ros::TransportHints().tcpNoDelay());
  };
  moving_ = subscribe("/tf", false);
  static_ = subscribe("/tf_static", true);
}

void TransformFeed::take(const tf2_msgs::TFMessage& message, bool is_static) {
  on_message_();
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    if (!is_static && isAhead(transform)) continue;
    try {
      buffer_.setTransform(transform, "/tf", is_static);
    } catch (const tf2::TransformException& error) {
      ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "/tf: " << onOneLine(error.what()));
    }
  }
}

// Before there is a time, all are.
bool TransformFeed::isAhead(const geometry_msgs::TransformStamped& transform) const {
  const ros::Time now = ros::Time::now();
  if (now.isZero()) return true;
  const double ahead = (transform.header.stamp - now).toSec();
  const double most = buffer_.getCacheLength().toSec();
  if (ahead <= most) return false;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "/tf: the transform of '"
                                            << shortText(transform.child_frame_id) << "' is "
                                            << numberText(ahead)
                                            << " s ahead of now and left out; allowed: at most "
                                            << numberText(most) << " s, that the buffer holds");
  return true;
}

}  // namespace robot_tissue
