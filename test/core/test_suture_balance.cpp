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

class StiffSuture : public ::testing::TestWithParam<double> {};

SutureConfig stiffThread(double stiffness) {
  SutureConfig thread = threadOf("s", {0.035, 0.03, 0.04}, {0.043, 0.03, 0.04});
  thread.stiffness = stiffness;
  return thread;
}

TEST_P(StiffSuture, OfNoLengthTellsTheTensionOfTheShape) {
  const TissueConfig config = bedOf(6);
  const SutureConfig thread = stiffThread(GetParam());
  Tissue exact(config, solverWith("newton", 1e-6));
  exact.suture(thread);
  exact.settle();
  const double tension = exact.sutures()[0].tension;
  EXPECT_GT(tension, 1.0);
  for (const char* method : {"layered", "newton"}) {
    Tissue tissue(config, solverWith(method, 1e-2));
    const SutureResult result = tissue.suture(thread);
    EXPECT_EQ(result.solve.status, SolveStatus::kOk);
    EXPECT_NEAR(result.suture.tension, tension, 0.005 * tension) << method;
    tissue.load(loadOf(
        {displacedPatch("b", nodeBox(config, {0, 0, 4}, {1, 1, 4}), Vec3(0.0, 0.0, 0.0002))}));
    EXPECT_EQ(tissue.release({"b"}).status, SolveStatus::kOk);
    EXPECT_NEAR(tissue.sutures()[0].tension, tension, 0.005 * tension) << method;
  }
}

// What it pulls with while it is drawn in softly is no reason to break, or to hold.
TEST_P(StiffSuture, BreaksByTheTensionOfTheShape) {
  const TissueConfig config = bedOf(6);
  SutureConfig thread = stiffThread(GetParam());
  Tissue strong(config, {});
  const double tension = strong.suture(thread).suture.tension;
  for (const double share : {0.95, 1.05}) {
    Tissue tissue(config, {});
    thread.break_force = share * tension;
    EXPECT_EQ(tissue.suture(thread).suture.broken, share < 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(, StiffSuture, ::testing::Values(1000.0, 5000.0, 1e5));

// Two on one wound that a load draws apart.
TEST(SutureBalance, StiffThreadsSideBySideTellTheTensionOfTheShape) {
  const TissueConfig config = bedOf(6);
  Tissue exact(config, solverWith("newton", 1e-6)), tissue(config, solverWith("layered"));
  for (Tissue* each : {&exact, &tissue}) {
    each->cut(planeAt(0.035, 0.01));
    each->load(loadOf(
        {displacedPatch("a", nodeBox(config, {0, 0, 4}, {1, 6, 4}), Vec3(-0.006, 0.0, 0.0))}));
    for (const double y : {0.025, 0.035}) {
      SutureConfig thread = threadOf("s" + std::to_string(each->sutures().size()), {0.027, y, 0.04},
                                     {0.033, y, 0.04});
      thread.stiffness = 5e4;
      EXPECT_EQ(each->suture(thread).solve.status, SolveStatus::kOk);
    }
  }
  exact.settle();
  for (std::size_t i = 0; i < 2; ++i) {
    const double tension = exact.sutures()[i].tension;
    EXPECT_NEAR(tissue.sutures()[i].tension, tension, 0.03 * tension);
  }
}

}  // namespace
}  // namespace robot_tissue::test_suture_balance
