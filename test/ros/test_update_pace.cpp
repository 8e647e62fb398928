// Which poses are due.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "robot_tissue/ros/update_pace.h"

namespace robot_tissue::test_update_pace {
namespace {

constexpr double kStart = 1e9, kRate = 200.0;  // s, Hz

int taken(const std::vector<double>& times, UpdatePace pace) {
  int count = 0;
  for (const double time : times) {
    if (!pace.isDue(time)) continue;
    pace.take(time);
    ++count;
  }
  return count;
}

// As many a second as `rate_hz`, each late by a time of its own (s).
std::vector<double> posesOf(double rate_hz, double mean_delay, int count) {
  std::mt19937 random(22);
  std::exponential_distribution<double> delay(1.0 / mean_delay);
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(kStart + i / rate_hz + delay(random));
  std::sort(times.begin(), times.end());
  return times;
}

TEST(UpdatePace, TakesPosesOfItsRateThatAreLate) {
  EXPECT_GT(taken(posesOf(kRate, 0.002, 2000), UpdatePace(kRate)), 1990);
}

TEST(UpdatePace, TakesNoMoreThanItsRate) {
  EXPECT_LE(taken(posesOf(1000.0, 0.002, 5000), UpdatePace(kRate)), 5 * kRate + 5);
}

TEST(UpdatePace, MakesUpForNoSilence) {
  UpdatePace pace(kRate);
  pace.take(kStart);
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) times.push_back(kStart + 1.0 + 1e-6 * i);
  EXPECT_LE(taken(times, pace), 3);
}

TEST(UpdatePace, BeginsAnewWhereTimeGoesBack) {
  UpdatePace pace(kRate);
  pace.take(kStart);
  EXPECT_TRUE(pace.isDue(kStart - 100.0));
}

}  // namespace
}  // namespace robot_tissue::test_update_pace
