#include "simd/workers.h"

namespace robot_tissue {
namespace {

// Times that a thread looks for the next job before it sleeps; it yields between looks. Jobs of a
// solve follow each other within microseconds, less than it takes to wake a thread. Chosen.
constexpr int kLooks = 2000;

}  // namespace

Workers::Workers(int threads) {
  for (int number = 1; number < threads; ++number) {
    threads_.emplace_back([this, number] { wait(number); });
  }
}

Workers::~Workers() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
    ++job_;
  }
  begins_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::run(const std::function<void(int)>& part) {
  if (threads_.empty()) return part(0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    part_ = &part;
    open_ = static_cast<int>(threads_.size());
    ++job_;
  }
  begins_.notify_all();
  part(0);
  while (open_.load(std::memory_order_acquire) > 0) std::this_thread::yield();
}

void Workers::wait(int number) {
  unsigned done = 0;
  while (true) {
    for (int look = 0; look < kLooks && job_.load(std::memory_order_acquire) == done; ++look) {
      std::this_thread::yield();
    }
    if (job_.load(std::memory_order_acquire) == done) {
      std::unique_lock<std::mutex> lock(mutex_);
      begins_.wait(lock, [&] { return job_.load() != done; });
    }
    done = job_.load(std::memory_order_acquire);
    if (ends_) return;
    (*part_)(number);
    open_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace robot_tissue
