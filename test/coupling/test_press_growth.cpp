// How hard links press goes on as it went.
#include <gtest/gtest.h>

#include "robot_tissue/coupling/press_growth.h"

namespace robot_tissue::test_press_growth {
namespace {

Pose atX(double x) { return Pose(Eigen::Translation3d(x, 0.0, 0.0)); }

// One link that pressed with 1 N at -1 mm and with 1.2 N at 0.
PressGrowth grownByAFifth() {
  PressGrowth growth;
  growth.note({atX(-0.001)}, {{1.0, Vec3(0.009, 0.0, 0.0)}});
  growth.note({atX(0.0)}, {{1.2, Vec3(0.01, 0.0, 0.0)}});
  return growth;
}

TEST(PressGrowth, GoesOnAsTheLinkDoes) {
  const PressGrowth growth = grownByAFifth();
  EXPECT_NEAR(1.2 * growth.times(0, atX(0.001)), 1.4, 1e-12);
  EXPECT_NEAR(1.2 * growth.times(0, atX(0.0005)), 1.3, 1e-12);
  EXPECT_NEAR(1.2 * growth.times(0, atX(-0.001)), 1.0, 1e-12);
}

TEST(PressGrowth, StaysWhereTheLinkStandsOrGoesAside) {
  const PressGrowth growth = grownByAFifth();
  EXPECT_EQ(growth.times(0, atX(0.0)), 1.0);
  EXPECT_EQ(growth.times(0, Pose(Eigen::Translation3d(0.0, 0.001, 0.0))), 1.0);
}

TEST(PressGrowth, NeedsTwoLoadStepsInWhichTheLinkPressed) {
  PressGrowth growth;
  EXPECT_EQ(growth.times(0, atX(0.001)), 1.0);
  growth.note({atX(-0.001)}, {{}});
  EXPECT_EQ(growth.times(0, atX(0.001)), 1.0);
  growth.note({atX(0.0)}, {{1.2, Vec3(0.01, 0.0, 0.0)}});
  EXPECT_EQ(growth.times(0, atX(0.001)), 1.0);
}

TEST(PressGrowth, AFarWayOrAFirstTouchIsBounded) {
  const PressGrowth growth = grownByAFifth();
  EXPECT_NEAR(1.2 * growth.times(0, atX(1.0)), 1.4, 1e-12);
  PressGrowth first;
  first.note({atX(-0.001)}, {{1e-9, Vec3::Zero()}});
  first.note({atX(0.0)}, {{1.0, Vec3::Zero()}});
  EXPECT_LE(first.times(0, atX(0.001)), 1.5);
}

TEST(PressGrowth, TellsWhichShareOfItsLastWayTheLinkGoes) {
  const PressGrowth growth = grownByAFifth();
  EXPECT_NEAR(growth.shareOfLastWay(0, atX(0.0004)), 0.4, 1e-12);
  EXPECT_NEAR(growth.shareOfLastWay(0, atX(-0.0004)), -0.4, 1e-12);
  EXPECT_EQ(growth.shareOfLastWay(0, atX(1.0)), 1.0);
  EXPECT_EQ(growth.shareOfLastWay(0, Pose(Eigen::Translation3d(0.0, 0.001, 0.0))), 0.0);
  EXPECT_EQ(PressGrowth().shareOfLastWay(0, atX(0.001)), 0.0);
}

// A pose times its inverse is one to rounding.
TEST(PressGrowth, ALinkThatStandsHasNoLastWay) {
  for (int turn = 1; turn <= 20; ++turn) {
    Pose stands = atX(0.1 * turn);
    stands.rotate(Eigen::AngleAxisd(0.3 * turn, Vec3(1.0, 2.0, 3.0).normalized()));
    PressGrowth growth;
    growth.note({stands}, {{1.0, Vec3(0.013, 0.029, 0.017)}});
    growth.note({stands}, {{1.2, Vec3(0.013, 0.029, 0.017)}});
    EXPECT_EQ(growth.times(0, stands), 1.0) << turn;
    EXPECT_EQ(growth.shareOfLastWay(0, stands), 0.0) << turn;
  }
}

}  // namespace
}  // namespace robot_tissue::test_press_growth
