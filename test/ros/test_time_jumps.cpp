// When time counts as gone back, and how far stamps are from each other.
#include <gtest/gtest.h>

#include "robot_tissue/ros/seconds_between.h"
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

TEST(SecondsBetween, AreThoseOfADurationAndGoBeyondIt) {
  const ros::Time early(10, 900000000), late(12, 100000001);
  EXPECT_EQ(secondsBetween(early, late), (late - early).toSec());
  EXPECT_EQ(secondsBetween(late, early), (early - late).toSec());
  EXPECT_EQ(secondsBetween(ros::Time(1, 5), ros::Time(4200000001, 5)), 4.2e9);
  EXPECT_EQ(secondsBetween(ros::Time(4200000001, 5), ros::Time(1, 5)), -4.2e9);
}

}  // namespace
}  // namespace robot_tissue::test_time_jumps
