// Ways are given up whose load steps take far too long again and again.
#include <gtest/gtest.h>

#include <limits>

#include "patience.h"

namespace robot_tissue {
namespace {

constexpr int kUsual = 30;

TEST(Patience, OutlastsASlipAndEndsInAJam) {
  Patience patience;
  patience.limit();
  patience.note(800, kUsual);
  EXPECT_FALSE(patience.isOver());
  int hard = 0;
  for (; hard < 1000 && !patience.isOver(); ++hard) patience.note(200, kUsual);
  EXPECT_LT(hard, 10);
}

TEST(Patience, ForgivesSlipsAmongEasyLoadSteps) {
  Patience patience;
  patience.limit();
  for (int slip = 0; slip < 100; ++slip) {
    patience.note(800, kUsual);
    for (int easy = 0; easy < 200; ++easy) patience.note(kUsual, kUsual);
    ASSERT_FALSE(patience.isOver()) << slip;
  }
}

TEST(Patience, EndsForNoMethodThatKnowsNoUsualLoadStep) {
  Patience patience;
  patience.limit();
  for (int i = 0; i < 100; ++i) patience.note(1000000, std::numeric_limits<int>::max());
  EXPECT_FALSE(patience.isOver());
}

TEST(Patience, LastsForeverUntilItIsLimited) {
  Patience patience;
  for (int i = 0; i < 100; ++i) patience.note(1000, kUsual);
  EXPECT_FALSE(patience.isOver());
  patience.limit();
  EXPECT_TRUE(patience.isOver());
  patience.forget();
  EXPECT_FALSE(patience.isOver());
}

}  // namespace
}  // namespace robot_tissue
