#include "robot_tissue/ros/wrench_publisher.h"

#include <ros/init.h>
#include <ros/rate.h>

#include <algorithm>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/tool_poses.h"

namespace robot_tissue {
namespace {

constexpr unsigned kQueue = 10;       // messages that a busy socket may hold up
const ros::WallDuration kIdle(0.02);  // between looks whether somebody listens

}  // namespace

WrenchPublisher::WrenchPublisher(const ros::NodeHandle& private_node, double rate_hz)
    : private_node_(private_node), rate_hz_(rate_hz) {}

WrenchPublisher::~WrenchPublisher() { stop(); }

void WrenchPublisher::setTools(const std::vector<ToolGeometry>& tools) {
  stop();
  publishers_.clear();
  messages_.assign(tools.size(), {});
  silent_ = true;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const std::string topic = tools[tool].name + "/measured_cf";
    publishers_.push_back(private_node_.advertise<geometry_msgs::WrenchStamped>(topic, kQueue));
    messages_[tool].header.frame_id = linkFrames(tools[tool]).front();
  }
  if (rate_hz_ <= 0.0 || tools.empty()) return;
  stops_ = false;
  thread_ = std::thread([this] { repeat(); });
}

void WrenchPublisher::publish(const std::vector<ToolReport>& reports, const ros::Time& stamp) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t tool = 0; tool < messages_.size(); ++tool) {
      messages_[tool].header.stamp = stamp;
      messages_[tool].wrench.force = toVector3(reports[tool].force_on_tool);
      messages_[tool].wrench.torque = toVector3(reports[tool].torque_on_tool);
    }
    silent_ = false;
  }
  if (rate_hz_ <= 0.0) send();
}

void WrenchPublisher::fallSilent() {
  const std::lock_guard<std::mutex> lock(mutex_);
  silent_ = true;
}

void WrenchPublisher::send() {
  std::vector<geometry_msgs::WrenchStamped> messages;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (silent_) return;
    messages = messages_;
  }
  for (std::size_t tool = 0; tool < messages.size(); ++tool) {
    publishers_[tool].publish(messages[tool]);
  }
}

void WrenchPublisher::repeat() {
  ros::WallRate rate(rate_hz_);
  while (!stops_ && ros::ok()) {
    if (isListenedTo()) {
      send();
      rate.sleep();
    } else {
      kIdle.sleep();
      rate.reset();
    }
  }
}

bool WrenchPublisher::isListenedTo() const {
  return std::any_of(publishers_.begin(), publishers_.end(), [](const ros::Publisher& publisher) {
    return publisher.getNumSubscribers() > 0;
  });
}

void WrenchPublisher::stop() {
  stops_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace robot_tissue
