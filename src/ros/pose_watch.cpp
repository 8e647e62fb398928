#include "robot_tissue/ros/pose_watch.h"

#include <boost/make_shared.hpp>
#include <utility>

namespace robot_tissue {

class PoseWatch::HandOver : public ros::CallbackInterface {
 public:
  explicit HandOver(PoseWatch& watch) : watch_(watch) {}

  CallResult call() override {
    watch_.handOver();
    return Success;
  }

 private:
  PoseWatch& watch_;  // takes its callbacks out of the queue before it goes
};

void PoseWatch::AtOnce::addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) {
  callback->call();
}

// A subscription goes only when it is not being called.
void PoseWatch::AtOnce::removeByID(std::uint64_t) {}

PoseWatch::PoseWatch(tf2_ros::Buffer& buffer, const ToolPoses& poses, double rate_hz,
                     ros::CallbackQueueInterface& queue, OnStill on_still, OnPose on_pose)
    : buffer_(buffer),
      queue_(queue),
      on_still_(std::move(on_still)),
      on_pose_(std::move(on_pose)),
      pick_(poses, rate_hz) {
  connection_ = buffer_._addTransformsChangedListener([this] { onTransforms(); });
  const auto time_went_back = [this, jumps = 0]() mutable {
    const int before = std::exchange(jumps, timeJumps());
    return jumps != before;
  };
  feed_ = std::make_unique<TransformFeed>(buffer_, at_once_, time_went_back);
}

PoseWatch::~PoseWatch() {
  feed_.reset();  // first: after it nothing more is received
  buffer_._removeTransformsChangedListener(connection_);
  queue_.removeByID(reinterpret_cast<std::uint64_t>(this));
}

void PoseWatch::start() {
  const std::lock_guard<std::mutex> lock(mutex_);
  started_ = true;
}

void PoseWatch::setRate(double rate_hz) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pick_.setRate(rate_hz);
}

PoseWatch::Seen PoseWatch::seen() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(seen_, Seen());
}

ros::Time PoseWatch::newestStill() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return seen_.still;
}

PoseWatch::Counts PoseWatch::counts() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(counts_, Counts());
}

bool PoseWatch::takeTurn() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return pick_.takeTurn(ros::Time::now());
}

int PoseWatch::timeJumps() {
  const std::lock_guard<std::mutex> lock(mutex_);
  noticeTime();
  return time_jumps_;
}

// With the mutex locked.
void PoseWatch::noticeTime() {
  if (!time_.wentBack(ros::Time::now(), ros::Time::isSimTime())) return;
  ++time_jumps_;
  buffer_.clear();
  waiting_.reset();
  still_.reset();
  seen_ = Seen();
  pick_.timeWentBack();
}

void PoseWatch::standAt(std::optional<StillPose> still) {
  const std::lock_guard<std::mutex> lock(mutex_);
  still_ = std::move(still);
}

// A good pose with a new stamp is handed to the spinner's thread, or answered here where nothing is
// to be done at it. Others are left to the timer, which tells what is wrong.
void PoseWatch::onTransforms() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!started_) return;
  std::optional<PoseLookUp> look_up = pick_.take(ros::Time::now());
  if (!look_up) return;
  seen_.any = true;
  ++counts_.came;
  if (!waiting_ && still_ && still_->holds(look_up->pose)) {
    seen_.still = look_up->stamp;
    return on_still_(look_up->stamp);
  }
  const bool is_awake = waiting_.has_value();
  if (is_awake) ++counts_.missed;
  waiting_ = std::move(look_up);
  if (!is_awake) {
    queue_.addCallback(boost::make_shared<HandOver>(*this), reinterpret_cast<std::uint64_t>(this));
  }
}

void PoseWatch::handOver() {
  std::optional<PoseLookUp> look_up;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    look_up.swap(waiting_);
    still_.reset();
  }
  if (look_up) on_pose_(std::move(*look_up));
}

}  // namespace robot_tissue
