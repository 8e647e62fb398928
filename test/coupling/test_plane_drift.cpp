// Planes drift as they did.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "robot_tissue/coupling/plane_drift.h"

namespace robot_tissue::test_plane_drift {
namespace {

constexpr double kDrift = 3e-5;  // m

TEST(PlaneDrift, ForeseesWhatItMet) {
  PlaneDrift drift;
  EXPECT_EQ(drift.foresee(1.0), 0.0);
  drift.meet(2.0 * kDrift);
  drift.meet(-kDrift);
  drift.learn();
  EXPECT_EQ(drift.foresee(1.0), kDrift);
  EXPECT_EQ(drift.foresee(0.5), 0.5 * kDrift);
  EXPECT_EQ(drift.foresee(-1.0), -kDrift);
  EXPECT_EQ(drift.foresee(0.0), 0.0);
}

TEST(PlaneDrift, StaysWhereItIsFulfilled) {
  PlaneDrift drift;
  drift.meet(kDrift);
  drift.learn();
  for (int step = 0; step < 3; ++step) {
    EXPECT_EQ(drift.foresee(1.0), kDrift);
    drift.learn();
  }
}

TEST(PlaneDrift, ComesToTheMeanOfOneThatSwings) {
  PlaneDrift drift;
  double foreseen = 0.0, farthest = 0.0;
  for (int step = 0; step < 20; ++step) {
    foreseen = drift.foresee(1.0);
    if (step > 10) farthest = std::max(farthest, std::abs(foreseen));
    drift.meet((step % 2 == 0 ? kDrift : -kDrift) - foreseen);
    drift.learn();
  }
  EXPECT_LT(farthest, 0.5 * kDrift);
  EXPECT_GT(farthest, 0.0);
}

TEST(PlaneDrift, ForgetsAndLearnsAnew) {
  PlaneDrift drift;
  drift.meet(kDrift);
  drift.learn();
  drift.forget();
  EXPECT_EQ(drift.foresee(1.0), 0.0);
  drift.meet(2.0 * kDrift);
  drift.learn();
  EXPECT_EQ(drift.foresee(1.0), 2.0 * kDrift);
}

TEST(PlaneDrift, ALoadStepThatIsBegunAnewHasMetNothing) {
  PlaneDrift drift;
  drift.foresee(1.0);
  drift.meet(5.0 * kDrift);
  drift.foresee(1.0);
  drift.meet(kDrift);
  drift.learn();
  EXPECT_EQ(drift.foresee(1.0), kDrift);
}

}  // namespace
}  // namespace robot_tissue::test_plane_drift
