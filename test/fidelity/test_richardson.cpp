// Limits that are known beforehand.
#include <gtest/gtest.h>

#include <cmath>

#include "richardson.h"

namespace robot_tissue::test_richardson {
namespace {

// limit + slope h^order
std::vector<Sample> powerLaw(const Eigen::VectorXd& limit, const Eigen::VectorXd& slope,
                             double order, const std::vector<double>& spacings) {
  std::vector<Sample> samples;
  for (const double spacing : spacings) {
    samples.push_back({spacing, limit + std::pow(spacing, order) * slope});
  }
  return samples;
}

const Eigen::VectorXd kLimit = (Eigen::VectorXd(3) << 1.0, -2.0, 0.5).finished();
const Eigen::VectorXd kSlope = (Eigen::VectorXd(3) << 0.3, 0.1, -7.0).finished();

TEST(Richardson, FindsLimitAndOrderOfAPower) {
  for (const double order : {0.5, 0.8, 1.0, 1.7, 2.0}) {
    for (const std::vector<double>& spacings :
         {std::vector<double>{4.0, 2.0, 1.0}, std::vector<double>{0.05 / 3, 0.01, 0.005}}) {
      const Limit limit = limitOf(powerLaw(kLimit, kSlope, order, spacings));
      EXPECT_NEAR(limit.observed, order, 1e-4);
      EXPECT_LT((limit.value - kLimit).norm(), 1e-4 * kLimit.norm()) << order;
    }
  }
}

TEST(Richardson, OrdersOutOfReachAreNotBelieved) {
  const Limit fast = limitOf(powerLaw(kLimit, kSlope, 3.0, {4.0, 2.0, 1.0}));
  EXPECT_NEAR(fast.observed, 3.0, 1e-4);
  EXPECT_EQ(fast.order, kHighestOrder);
  const Limit slow = limitOf(powerLaw(kLimit, kSlope, 0.1, {4.0, 2.0, 1.0}));
  EXPECT_NEAR(slow.observed, 0.1, 1e-4);
  EXPECT_EQ(slow.order, kLowestOrder);
}

TEST(Richardson, AnswersThatDepartFromEachOtherAreOfNegativeOrder) {
  Sample a{4.0, kLimit}, b{2.0, kLimit + 0.1 * kSlope}, c{1.0, kLimit + 0.3 * kSlope};
  const Limit limit = limitOf({a, b, c});
  EXPECT_LT(limit.observed, -0.5);
  EXPECT_EQ(limit.order, kLowestOrder);
}

TEST(Richardson, TwoAnswersAreTakenAsOfFirstOrder) {
  const Limit limit = limitOf(powerLaw(kLimit, kSlope, 1.0, {3.0, 1.0}));
  EXPECT_EQ(limit.order, 1.0);
  EXPECT_LT((limit.value - kLimit).norm(), 1e-12);
}

TEST(Richardson, EqualAnswersAreTheLimit) {
  const Limit limit = limitOf({{4.0, kLimit}, {2.0, kLimit}, {1.0, kLimit}});
  EXPECT_EQ(limit.value, kLimit);
}

}  // namespace
}  // namespace robot_tissue::test_richardson
