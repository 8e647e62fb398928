// When time counts as gone back.
#include <gtest/gtest.h>

#include "robot_tissue/ros/time_jumps.h"

namespace robot_tissue::test_time_jumps {
namespace {

constexpr double kStart = 1e9;  // s

TEST(TimeJumps, SimulatedTimeGoesBackByTheLeast) {
  TimeJumps jumps;
  EXPECT_FALSE(jumps.wentBack(ros::Time(kStart), true));
  EXPECT_FALSE(jumps.wentBack(ros::Time(kStart), true));
  EXPECT_TRUE(jumps.wentBack(ros::Time(kStart - 0.001), true));
  EXPECT_FALSE(jumps.wentBack(ros::Time(kStart - 0.0005), true));
}

TEST(TimeJumps, AClockThatIsSetBackALittleIsTheSameTime) {
  TimeJumps jumps;
  EXPECT_FALSE(jumps.wentBack(ros::Time(kStart), false));
  EXPECT_FALSE(jumps.wentBack(ros::Time(kStart - 0.3), false));
  EXPECT_TRUE(jumps.wentBack(ros::Time(kStart - 0.6), false));  // by little steps, too
  EXPECT_FALSE(jumps.wentBack(ros::Time(kStart - 0.9), false));
  EXPECT_TRUE(jumps.wentBack(ros::Time(kStart - 3600.0), false));
}

}  // namespace
}  // namespace robot_tissue::test_time_jumps
