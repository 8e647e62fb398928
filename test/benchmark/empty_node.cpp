// The least that a node costs which listens to TF and tells wrenches: it looks nothing up and
// solves nothing. For scripts/study still_node, beside the tissue node.
//
// usage: empty_node LISTENER WRENCHES
//   LISTENER  none | own_thread (of tf2) | node_queue (the node's one thread) | at_once (the thread
//             of roscpp that receives)
//   WRENCHES  none | pose (one for each message of TF) | their rate (Hz, from a thread)
#include <geometry_msgs/WrenchStamped.h>
#include <ros/callback_queue_interface.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

namespace {

class AtOnce : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
    callback->call();
  }
  void removeByID(std::uint64_t) override {}
};

// Once a message of TF, in the listener's thread.
class WrenchesAtPoses {
 public:
  WrenchesAtPoses(tf2_ros::Buffer& buffer, const ros::Publisher& wrenches)
      : buffer_(buffer), connection_(buffer._addTransformsChangedListener([wrenches] {
          wrenches.publish(geometry_msgs::WrenchStamped());
        })) {}
  ~WrenchesAtPoses() { buffer_._removeTransformsChangedListener(connection_); }

 private:
  tf2_ros::Buffer& buffer_;
  boost::signals2::connection connection_;
};

void repeat(const ros::Publisher& wrenches, double rate_hz) {
  ros::WallRate rate(rate_hz);
  while (ros::ok()) {
    wrenches.publish(geometry_msgs::WrenchStamped());
    rate.sleep();
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "empty_node");
  if (argc != 3) {
    ROS_FATAL("usage: empty_node none|own_thread|node_queue|at_once none|pose|RATE");
    return 2;
  }
  const std::string listening = argv[1], telling = argv[2];
  ros::NodeHandle node("~");
  ros::Publisher wrenches = node.advertise<geometry_msgs::WrenchStamped>("sphere/measured_cf", 10);
  AtOnce at_once;
  ros::NodeHandle listening_node(node);
  if (listening == "at_once") listening_node.setCallbackQueue(&at_once);
  tf2_ros::Buffer buffer;
  std::unique_ptr<tf2_ros::TransformListener> listener;
  if (listening != "none") {
    listener = std::make_unique<tf2_ros::TransformListener>(
        buffer, listening_node, listening == "own_thread", ros::TransportHints().tcpNoDelay());
  }
  std::unique_ptr<WrenchesAtPoses> at_poses;
  std::thread at_rate;
  if (telling == "pose") {
    at_poses = std::make_unique<WrenchesAtPoses>(buffer, wrenches);
  } else if (telling != "none") {
    at_rate = std::thread([&] { repeat(wrenches, std::stod(telling)); });
  }
  ros::spin();
  if (at_rate.joinable()) at_rate.join();
  return 0;
}
