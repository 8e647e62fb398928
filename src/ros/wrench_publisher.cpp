#include "robot_tissue/ros/wrench_publisher.h"

#include <algorithm>
#include <chrono>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/ros/tissue_messages.h"
#include "robot_tissue/ros/tool_poses.h"
#include "tuning.h"

namespace robot_tissue {
WrenchPublisher::WrenchPublisher(const ros::NodeHandle& private_node, const ToolPoses& poses,
                                 double rate_hz)
    : private_node_(private_node), poses_(poses), rate_hz_(rate_hz) {}

WrenchPublisher::~WrenchPublisher() { stop(); }

void WrenchPublisher::setTools(const std::vector<ToolGeometry>& tools) {
  stop();
  tools_.clear();
  silent_ = true;
  has_told_ = false;
  const auto someone_came = [this](const ros::SingleSubscriberPublisher&) {
    const std::lock_guard<std::mutex> lock(mutex_);
    changed_.notify_one();
  };
  const auto advertise = [&](const std::string& topic) {
    return private_node_.advertise<geometry_msgs::WrenchStamped>(topic, tuning::kWrenchQueue,
                                                                 someone_came);
  };
  std::size_t link = 0;
  for (const ToolGeometry& tool : tools) {
    Told told{advertise(tool.name + "/measured_cf"),
              advertise(tool.name + "/predicted_cf"),
              {},
              link,
              WrenchPrediction(tuning::kArmOfTurn, tool.max_force),
              {}};
    told.message.header.frame_id = linkFrames(tool).front();
    tools_.push_back(told);
    link += tool.links.size();
  }
  if (rate_hz_ <= 0.0 || tools.empty()) return;
  stops_ = false;
  thread_ = std::thread([this] { repeat(); });
}

void WrenchPublisher::publish(const Pipeline& pipeline, const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const ToolReport& report = pipeline.report().tools[tool];
    Told& told = tools_[tool];
    told.message.header.stamp = stamp;
    told.message.wrench = wrenchOn(report);
    if (!pipeline.pose()) continue;
    told.prediction.learnFrom(pipeline.pose()->links[told.first_link], report);
    if (pipeline.tissue().isLoading()) told.prediction.skipNextChange();  // a load is on its way
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
  for (Told& told : tools_) told.message.header.stamp = stamp;
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
  for (Told& told : tools_) {
    told.prediction.forget();
    told.predicted_until = ros::Time();
  }
}

void WrenchPublisher::tissueIsToChange() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Told& told : tools_) told.prediction.skipNextChange();
}

// With the mutex locked.
void WrenchPublisher::send() {
  if (silent_) return;
  for (const Told& told : tools_) {
    if (told.solved.getNumSubscribers() > 0) told.solved.publish(told.message);
    // Without a rate of its own it is of the pose that was solved for.
    if (rate_hz_ <= 0.0 && told.predicted.getNumSubscribers() > 0) {
      told.predicted.publish(told.message);
    }
  }
}

// Transforms are looked up without the mutex: who receives them may wait for it.
void WrenchPublisher::sendPredicted() {
  for (Told& told : tools_) {
    if (told.predicted.getNumSubscribers() == 0) continue;
    const auto newest = poses_.newest(told.message.header.frame_id);
    if (!newest) continue;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (silent_) return;
    sendPredicted(told, *newest);
  }
}

// With the mutex locked.
void WrenchPublisher::sendPredicted(Told& told, const ToolPoses::Newest& newest) {
  geometry_msgs::WrenchStamped message = told.message;
  const double age_s = secondsBetween(told.message.header.stamp, newest.stamp);
  if (told.prediction.foretells(newest.tissue_T_frame, age_s)) {
    const ToolWrench wrench = told.prediction.at(newest.tissue_T_frame);
    const Eigen::Matrix3d tool_R_tissue = newest.tissue_T_frame.linear().transpose();
    message.header.stamp = newest.stamp;
    message.wrench.force = toVector3(tool_R_tissue * wrench.force);
    message.wrench.torque = toVector3(tool_R_tissue * wrench.torque);
    if (message.header.stamp < told.predicted_until) return;
  } else if (message.header.stamp <= told.predicted_until) {
    return;
  }
  told.predicted_until = message.header.stamp;
  told.predicted.publish(message);
}

// Late by more than a period it makes up for none.
void WrenchPublisher::repeat() {
  using Clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_hz_));
  std::unique_lock<std::mutex> lock(mutex_);
  Clock::time_point due = Clock::now();
  while (!stops_) {
    if (isListenedTo()) {
      send();
      lock.unlock();
      sendPredicted();
      lock.lock();
      due += period;
      due = Clock::now() - due > period ? Clock::now() : due;
      changed_.wait_until(lock, due, [this] { return stops_; });
    } else {
      changed_.wait(lock);
      due = Clock::now();
    }
  }
}

bool WrenchPublisher::isListenedTo() const {
  return std::any_of(tools_.begin(), tools_.end(), [](const Told& told) {
    return told.solved.getNumSubscribers() > 0 || told.predicted.getNumSubscribers() > 0;
  });
}

void WrenchPublisher::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

}  // namespace robot_tissue
