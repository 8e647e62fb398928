// Threads that wait for parts of a job (own). The caller works, too, so `Workers(1)` has none.
//
// Parts are as large as their threads were fast lately: cores are of different speeds, or have
// other work. So only jobs whose result is the same however they are parted may be shared so.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace robot_tissue {

// What share of a job each of several threads takes.
class WorkShares {
 public:
  explicit WorkShares(int threads);  // equal ones

  // Of so many items, the first of a thread's part; of the thread after the last: `items`.
  int firstOf(int items, int thread) const;
  // These parts of so many items took so many seconds.
  void learn(int items, const std::vector<double>& seconds);

 private:
  std::vector<double> of_thread_;  // their sum is 1
};

class Workers {
 public:
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return static_cast<int>(threads_.size()) + 1; }
  // Calls `part` with 0 .. count() - 1, each in a thread; returns when all are done.
  void run(const std::function<void(int)>& part);
  // Calls part(first, end) for all of 0 .. items - 1, each in the thread that has that share.
  void share(int items, const std::function<void(int, int)>& part);
  // Likewise part(thread, first, end), and learns how fast the threads are.
  void shareAndLearn(int items, const std::function<void(int, int, int)>& part);

 private:
  void wait(int number);

  const int quick_looks_;  // kQuickLooks, or none
  WorkShares shares_;
  std::vector<double> seconds_;  // that the last job's parts took
  const std::function<void(int)>* part_ = nullptr;
  std::atomic<unsigned> job_{0};  // number of the present one
  std::atomic<int> open_{0};      // threads that are not done with it
  std::atomic<bool> ends_{false};
  std::mutex mutex_;
  std::condition_variable begins_;
  std::vector<std::thread> threads_;
};

}  // namespace robot_tissue
