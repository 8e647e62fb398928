// Sutures: the tension that is told is that of the shape, however stiff they are, and they break by
// it alone.
#include <gtest/gtest.h>

#include <string>

#include "suture_fixtures.h"

namespace robot_tissue::test_suture_balance {
namespace {

TissueConfig bedOf(int cells_y) {
  TissueConfig config = withFixedBottom(blockOf(8, cells_y, 4, 0.01));
  config.model = "elastic";
  config.material.poisson_ratio = 0.45;
  return config;
}

// A wound, drawn together beside it by load "a", and a thread across it which that load relieves.
SutureReport suturedBesideALoad(Tissue& tissue, const TissueConfig& config, double break_force) {
  tissue.cut(planeAt(0.035, 0.015));
  tissue.load(
      loadOf({displacedPatch("a", nodeBox(config, {0, 0, 4}, {1, 4, 4}), Vec3(0.006, 0.0, 0.0))}));
  SutureConfig thread = threadOf("s", {0.031, 0.02, 0.04}, {0.05, 0.02, 0.04});
  thread.rest_length = 0.015;
  thread.break_force = break_force;
  return tissue.suture(thread).suture;
}

LoadStep liftEnd(const TissueConfig& config) {
  return loadOf(
      {displacedPatch("b", nodeBox(config, {7, 0, 4}, {8, 4, 4}), Vec3(0.0, 0.0, 0.0002))});
}

TEST(SutureBalance, AThreadDoesNotBreakOnTheWayFromRestToTheLoadsThatStay) {
  const TissueConfig config = bedOf(4);
  Tissue strong(config, {}), weak(config, {});
  suturedBesideALoad(strong, config, 0.0);
  strong.load(liftEnd(config));
  strong.release({"b"});
  const double tension = strong.sutures()[0].tension;
  suturedBesideALoad(weak, config, 1.3 * tension);
  weak.load(liftEnd(config));
  ASSERT_FALSE(weak.sutures()[0].broken);
  EXPECT_EQ(weak.release({"b"}).status, SolveStatus::kOk);
  EXPECT_FALSE(weak.sutures()[0].broken);
  EXPECT_NEAR(weak.sutures()[0].tension, tension, 1e-9);
}

TEST(SutureBalance, AThreadDoesNotBreakAsTheLastToolLeaves) {
  const TissueConfig config = bedOf(4);
  Tissue tissue(config, {});
  suturedBesideALoad(tissue, config, 0.1147);
  LoadingPatch tool = displaced(tissue.lattice().nodesIn(nodeBox(config, {7, 2, 4}, {7, 2, 4})),
                                Vec3(0.0, 0.0, -0.0005));
  tissue.follow({tool}, {});
  ASSERT_FALSE(tissue.sutures()[0].broken);
  tissue.follow({}, {});
  EXPECT_FALSE(tissue.sutures()[0].broken);
}

// The loads that stay bear it no longer.
TEST(SutureBalance, AThreadBreaksInTheReleaseThatLeavesItTooMuch) {
  const TissueConfig config = bedOf(4);
  for (const bool other_stays : {false, true}) {
    Tissue strong(config, {}), weak(config, {});
    for (Tissue* each : {&strong, &weak}) {
      const double break_force = each == &weak ? 0.1147 : 0.0;
      EXPECT_LT(suturedBesideALoad(*each, config, break_force).tension, 0.1);
      if (other_stays) each->load(liftEnd(config));
      ASSERT_FALSE(each->sutures()[0].broken);
      EXPECT_EQ(each->release({"a"}).status, SolveStatus::kOk);
    }
    EXPECT_GT(strong.sutures()[0].tension, 0.1147);
    EXPECT_TRUE(weak.sutures()[0].broken);
  }
}

// Out of time on the way, too: what is due comes to stand first.
TEST(SutureBalance, AThreadDoesNotBreakOnALateWayFromRest) {
  const TissueConfig config = bedOf(4);
  Tissue tissue(config, {});
  suturedBesideALoad(tissue, config, 0.1147);
  tissue.load(liftEnd(config));
  tissue.setDeadline(Deadline(0.0));
  EXPECT_EQ(tissue.release({"b"}).status, SolveStatus::kLate);
  tissue.setDeadline(std::nullopt);
  while (tissue.isLoading()) tissue.loadOn();
  tissue.settle();
  EXPECT_FALSE(tissue.isLate());
  EXPECT_FALSE(tissue.sutures()[0].broken);
  EXPECT_NEAR(tissue.sutures()[0].tension, 0.0857, 0.005);
}

}  // namespace
}  // namespace robot_tissue::test_suture_balance
