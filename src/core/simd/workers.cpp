#include "simd/workers.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace robot_tissue {
namespace {

// Times that a thread looks for what it waits for before it yields between looks, and then before
// it sleeps. Jobs of a solve follow each other within microseconds, less than a yield takes (a look
// 20 ns, a yield 1 us), and much less than it takes to wake a thread. Chosen.
constexpr int kQuickLooks = 1000;
constexpr int kLooks = 2000;

// Share that the last job has in what is known of the threads' speeds, and the least share of a
// thread, times its equal one, so that one that was stopped is asked again. Chosen.
constexpr double kLearned = 0.1;
constexpr double kLeastShare = 0.2;

// Tells the processor that this thread waits.
void pauseShortly() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

template <typename Condition>
bool waitBriefly(int quick_looks, Condition holds) {
  for (int look = 0; look < quick_looks; ++look) {
    if (holds()) return true;
    pauseShortly();
  }
  for (int look = 0; look < kLooks; ++look) {
    if (holds()) return true;
    std::this_thread::yield();
  }
  return holds();
}

}  // namespace

WorkShares::WorkShares(int threads)
    : of_thread_(static_cast<std::size_t>(threads), 1.0 / threads) {}

int WorkShares::firstOf(int items, int thread) const {
  const auto end = of_thread_.begin() + thread;
  if (end == of_thread_.end()) return items;
  return static_cast<int>(std::lround(items * std::accumulate(of_thread_.begin(), end, 0.0)));
}

void WorkShares::learn(int items, const std::vector<double>& seconds) {
  const int threads = static_cast<int>(of_thread_.size());
  std::vector<double> speeds;
  for (int thread = 0; thread < threads; ++thread) {
    const int done = firstOf(items, thread + 1) - firstOf(items, thread);
    const double took = seconds[static_cast<std::size_t>(thread)];
    if (done == 0 || !(took > 0.0)) return;
    speeds.push_back(done / took);
  }
  const double of_all = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    of_thread_[i] += kLearned * (speeds[i] / of_all - of_thread_[i]);
    of_thread_[i] = std::max(of_thread_[i], kLeastShare / threads);
    sum += of_thread_[i];
  }
  for (double& share : of_thread_) share /= sum;
}

// Threads without a processor of their own let others work at once.
Workers::Workers(int threads)
    : quick_looks_(threads <= static_cast<int>(std::thread::hardware_concurrency()) ? kQuickLooks
                                                                                    : 0),
      shares_(threads),
      seconds_(static_cast<std::size_t>(threads), 0.0) {
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
  while (
      !waitBriefly(quick_looks_, [this] { return open_.load(std::memory_order_acquire) == 0; })) {
  }
}

void Workers::share(int items, const std::function<void(int, int)>& part) {
  run([&](int thread) {
    part(shares_.firstOf(items, thread), shares_.firstOf(items, thread + 1));
  });
}

void Workers::shareAndLearn(int items, const std::function<void(int, int, int)>& part) {
  using Clock = std::chrono::steady_clock;
  run([&](int thread) {
    const Clock::time_point start = Clock::now();
    part(thread, shares_.firstOf(items, thread), shares_.firstOf(items, thread + 1));
    seconds_[static_cast<std::size_t>(thread)] =
        std::chrono::duration<double>(Clock::now() - start).count();
  });
  shares_.learn(items, seconds_);
}

void Workers::wait(int number) {
  unsigned done = 0;
  while (true) {
    if (!waitBriefly(quick_looks_, [&] { return job_.load(std::memory_order_acquire) != done; })) {
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
