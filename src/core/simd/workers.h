// Threads that wait for parts of a job (own). The caller works, too, so `Workers(1)` has none.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace robot_tissue {

class Workers {
 public:
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return static_cast<int>(threads_.size()) + 1; }
  // Calls `part` with 0 .. count() - 1, each in a thread; returns when all are done.
  void run(const std::function<void(int)>& part);

 private:
  void wait(int number);

  const std::function<void(int)>* part_ = nullptr;
  std::atomic<unsigned> job_{0};  // number of the present one
  std::atomic<int> open_{0};      // threads that are not done with it
  std::atomic<bool> ends_{false};
  std::mutex mutex_;
  std::condition_variable begins_;
  std::vector<std::thread> threads_;
};

}  // namespace robot_tissue
