#include "robot_tissue/ros/transform_watch.h"

#include <atomic>
#include <boost/make_shared.hpp>
#include <utility>

namespace robot_tissue {

// Outlives the watch while the listener's thread is still in its signal.
struct TransformWatch::Wake {
  std::function<void()> on_transforms;
  std::atomic<bool> waits{false};  // in the queue
};

namespace {

template <class Wake>
class WakeCallback : public ros::CallbackInterface {
 public:
  explicit WakeCallback(std::weak_ptr<Wake> wake) : wake_(std::move(wake)) {}

  CallResult call() override {
    const std::shared_ptr<Wake> wake = wake_.lock();
    if (!wake) return Invalid;
    wake->waits = false;
    wake->on_transforms();
    return Success;
  }

 private:
  std::weak_ptr<Wake> wake_;
};

}  // namespace

TransformWatch::TransformWatch(tf2_ros::Buffer& buffer, ros::CallbackQueueInterface& queue,
                               std::function<void()> on_transforms)
    : buffer_(buffer), queue_(queue), wake_(std::make_shared<Wake>()) {
  wake_->on_transforms = std::move(on_transforms);
  const auto owner = reinterpret_cast<std::uint64_t>(this);
  connection_ = buffer_._addTransformsChangedListener(
      [wake = std::weak_ptr<Wake>(wake_), &queue = queue_, owner] {
        const std::shared_ptr<Wake> there = wake.lock();
        if (!there || there->waits.exchange(true)) return;
        queue.addCallback(boost::make_shared<WakeCallback<Wake>>(wake), owner);
      });
}

TransformWatch::~TransformWatch() {
  buffer_._removeTransformsChangedListener(connection_);
  wake_.reset();
  queue_.removeByID(reinterpret_cast<std::uint64_t>(this));
}

}  // namespace robot_tissue
