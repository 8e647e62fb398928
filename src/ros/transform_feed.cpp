#include "robot_tissue/ros/transform_feed.h"

#include <utility>

#include "tuning.h"

namespace robot_tissue {

TransformFeed::TransformFeed(tf2::BufferCore& buffer, ros::CallbackQueueInterface& queue,
                             std::function<bool()> time_went_back)
    : intake_(buffer, std::move(time_went_back)) {
  using Kind = TransformIntake::Kind;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  const auto subscribe = [&](const char* topic, Kind kind) {
    const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> take =
        [this, kind](const tf2_msgs::TFMessageConstPtr& message) { intake_.take(*message, kind); };
    return node.subscribe<tf2_msgs::TFMessage>(topic, tuning::kTransformQueue, take,
                                               ros::VoidConstPtr(),
                                               ros::TransportHints().tcpNoDelay());
  };
  moving_ = subscribe("/tf", Kind::kMoving);
  static_ = subscribe("/tf_static", Kind::kStatic);
}

}  // namespace robot_tissue
