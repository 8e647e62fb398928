// The longer a load step takes, the less it is content with.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "robot_tissue/core/load_step_bound.h"

namespace robot_tissue::test_load_step_bound {
namespace {

TEST(LoadStepBound, IsNoneOutsideOfALoadStep) {
  LoadStepBound bound;
  bound.note(1000);
  EXPECT_FALSE(bound.isSpent());
  EXPECT_EQ(bound.left(), std::numeric_limits<int>::max());
  EXPECT_EQ(bound.bearableDepth(), 0.0);
  {
    const LoadStepBound::Scope load_step(bound, 10);
    bound.note(10);
    EXPECT_TRUE(bound.isSpent());
  }
  EXPECT_FALSE(bound.isSpent());
}

TEST(LoadStepBound, BearsMoreTheLongerItTakes) {
  LoadStepBound bound;
  const LoadStepBound::Scope load_step(bound, 30);
  bound.note(9);
  EXPECT_EQ(bound.bearableDepth(), 0.0);
  double before = 0.0;
  for (int made = 10; made <= 30; made += 5) {
    bound.note(made == 10 ? 1 : 5);
    EXPECT_GT(bound.bearableDepth(), before) << made;
    EXPECT_EQ(bound.left(), std::max(1, 30 - made));
    before = bound.bearableDepth();
  }
  bound.note(100);
  EXPECT_EQ(bound.bearableDepth(), before);
}

TEST(LoadStepBound, EachLoadStepBeginsAnew) {
  LoadStepBound bound;
  for (int load_step = 0; load_step < 3; ++load_step) {
    const LoadStepBound::Scope scope(bound, 5);
    EXPECT_EQ(bound.left(), 5);
    bound.note(4);
    EXPECT_EQ(bound.left(), 1);
  }
}

}  // namespace
}  // namespace robot_tissue::test_load_step_bound
