// Threads that share a job.
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "simd/workers.h"

namespace robot_tissue::test_workers {
namespace {

TEST(Workers, EachPartIsDoneOnceInItsThread) {
  for (const int threads : {1, 2, 5}) {
    Workers workers(threads);
    std::vector<int> done(static_cast<std::size_t>(threads), 0);
    for (int job = 0; job < 100; ++job) {
      workers.run([&done](int part) { ++done[static_cast<std::size_t>(part)]; });
    }
    EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(threads), 100)) << threads;
  }
}

// Whatever the threads were seen to be fast.
TEST(Workers, PartsAreAllItemsOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    Workers workers(threads);
    for (const int items : {0, 1, 2, 41, 1000}) {
      std::vector<std::atomic<int>> done(static_cast<std::size_t>(items));
      for (int job = 0; job < 20; ++job) {
        const auto take = [&done](int first, int end) {
          for (int i = first; i < end; ++i) ++done[static_cast<std::size_t>(i)];
        };
        workers.shareAndLearn(items,
                              [&take](int /*thread*/, int first, int end) { take(first, end); });
        workers.share(items, take);
      }
      for (const std::atomic<int>& times : done) EXPECT_EQ(times, 40) << threads << ' ' << items;
    }
  }
}

TEST(WorkShares, ASlowThreadGetsFewerItems) {
  WorkShares shares(2);
  constexpr int kItems = 1000;
  EXPECT_EQ(shares.firstOf(kItems, 1), kItems / 2);
  const auto take = [&shares](double first_per_second, double second_per_second) {
    for (int job = 0; job < 100; ++job) {
      const int first = shares.firstOf(kItems, 1);
      shares.learn(kItems, {first / first_per_second, (kItems - first) / second_per_second});
    }
  };
  take(4.0, 1.0);
  EXPECT_NEAR(shares.firstOf(kItems, 1), 800, 2);
  take(1.0, 1.0);
  EXPECT_NEAR(shares.firstOf(kItems, 1), 500, 2);
}

// It would not be asked again.
TEST(WorkShares, AThreadThatStoodStillKeepsAPart) {
  WorkShares shares(3);
  for (int job = 0; job < 1000; ++job) shares.learn(300, {1.0, 1.0, 1e6});
  EXPECT_GT(shares.firstOf(300, 3) - shares.firstOf(300, 2), 10);
}

TEST(WorkShares, WhatTookNoTimeTeachesNothing) {
  WorkShares shares(2);
  shares.learn(10, {0.0, 1.0});
  shares.learn(0, {1.0, 2.0});
  EXPECT_EQ(shares.firstOf(10, 1), 5);
}

}  // namespace
}  // namespace robot_tissue::test_workers
