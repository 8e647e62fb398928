#include "settling_notice.h"

#include <chrono>
#include <utility>

#include "tuning.h"

namespace robot_tissue {

SettlingNotice::SettlingNotice(const TissuePublisher& publisher,
                               diagnostic_updater::Updater& diagnostics, TissueState state)
    : publisher_(publisher),
      diagnostics_(diagnostics),
      state_(std::move(state)),
      thread_([this] { tellOn(); }) {}

SettlingNotice::~SettlingNotice() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  end_.notify_one();
  thread_.join();
}

void SettlingNotice::tellOn() {
  const std::chrono::duration<double> period(tuning::kSettlingPeriod);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!is_over_) {
    publisher_.tell(state_);
    diagnostics_.broadcast(diagnostic_msgs::DiagnosticStatus::OK, state_.message);
    end_.wait_for(lock, period, [this] { return is_over_; });
  }
}

}  // namespace robot_tissue
