#include "robot_tissue/ros/wrench_publisher.h"

#include <ros/rate.h>

#include <algorithm>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/tool_poses.h"
#include "tuning.h"

namespace robot_tissue {
WrenchPublisher::WrenchPublisher(const ros::NodeHandle& private_node, double rate_hz)
    : private_node_(private_node), rate_hz_(rate_hz) {}

WrenchPublisher::~WrenchPublisher() { stop(); }

void WrenchPublisher::setTools(const std::vector<ToolGeometry>& tools) {
  stop();
  publishers_.clear();
  messages_.assign(tools.size(), {});
  silent_ = true;
  has_told_ = false;
  const auto someone_came = [this](const ros::SingleSubscriberPublisher&) {
    const std::lock_guard<std::mutex> lock(mutex_);
    listener_came_.notify_one();
  };
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const std::string topic = tools[tool].name + "/measured_cf";
    publishers_.push_back(private_node_.advertise<geometry_msgs::WrenchStamped>(
        topic, tuning::kWrenchQueue, someone_came));
    messages_[tool].header.frame_id = linkFrames(tools[tool]).front();
  }
  if (rate_hz_ <= 0.0 || tools.empty()) return;
  stops_ = false;
  thread_ = std::thread([this] { repeat(); });
}

void WrenchPublisher::publish(const std::vector<ToolReport>& reports, const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t tool = 0; tool < messages_.size(); ++tool) {
    messages_[tool].header.stamp = stamp;
    messages_[tool].wrench.force = toVector3(reports[tool].force_on_tool);
    messages_[tool].wrench.torque = toVector3(reports[tool].torque_on_tool);
  }
  silent_ = false;
  has_told_ = true;
  if (rate_hz_ <= 0.0) send();
}

void WrenchPublisher::publishOld() {
  const std::lock_guard<std::mutex> lock(mutex_);
  silent_ = !has_told_;
  if (rate_hz_ <= 0.0) send();
}

void WrenchPublisher::publishAgain(const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (geometry_msgs::WrenchStamped& message : messages_) message.header.stamp = stamp;
  if (rate_hz_ <= 0.0) send();
}

void WrenchPublisher::fallSilent() {
  const std::lock_guard<std::mutex> lock(mutex_);
  silent_ = true;
}

void WrenchPublisher::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  silent_ = true;
  has_told_ = false;
}

// With the mutex locked.
void WrenchPublisher::send() {
  if (silent_) return;
  for (std::size_t tool = 0; tool < messages_.size(); ++tool) {
    if (publishers_[tool].getNumSubscribers() > 0) publishers_[tool].publish(messages_[tool]);
  }
}

void WrenchPublisher::repeat() {
  ros::WallRate rate(rate_hz_);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stops_) {
    if (isListenedTo()) {
      send();
      lock.unlock();
      rate.sleep();
      lock.lock();
    } else {
      listener_came_.wait(lock);
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
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
    listener_came_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

}  // namespace robot_tissue
