// While it lives, it is told that the tissue comes to lie on its supports: the node does nothing
// else for seconds then, and would look hung.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <robot_tissue/TissueState.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "robot_tissue/ros/tissue_publisher.h"

namespace robot_tissue {

class SettlingNotice {
 public:
  // `state`: what is told. What is handed in must outlive this.
  SettlingNotice(const TissuePublisher& publisher, diagnostic_updater::Updater& diagnostics,
                 TissueState state);
  ~SettlingNotice();
  SettlingNotice(const SettlingNotice&) = delete;
  SettlingNotice& operator=(const SettlingNotice&) = delete;

 private:
  void tellOn();

  const TissuePublisher& publisher_;
  diagnostic_updater::Updater& diagnostics_;
  TissueState state_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool is_over_ = false;
  std::thread thread_;  // the last: it has all the others
};

}  // namespace robot_tissue
