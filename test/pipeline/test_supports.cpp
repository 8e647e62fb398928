// Tissue without fixed nodes lies on supports.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_supports {
namespace {

class LyingBlock : public ::testing::TestWithParam<const char*> {
 protected:
  static TissueConfig lying(const Vec3& gravity = Vec3(0.0, 0.0, -9.81)) {
    TissueConfig tissue = block("elastic", 0.01);
    tissue.fixed.clear();
    tissue.gravity = gravity;
    return tissue;
  }
  static SolverConfig solver() {
    SolverConfig solver;
    solver.method = GetParam();
    return solver;
  }
  static SupportConfig table(double friction = 0.3) { return {"table", planeOf(true), friction}; }
  static double weight() { return 9.81 * 1000.0 * kWidth * kWidth * kTop; }

  static double lowest(const Tissue& tissue) {
    double lowest = tissue.vertices().front().z();
    for (const Vec3& vertex : tissue.vertices()) lowest = std::min(lowest, vertex.z());
    return lowest;
  }
};

TEST_P(LyingBlock, IsBorneWithItsWeight) {
  Pipeline pipeline(lying(), solver(), {}, {table()});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_NEAR(balance.weight.z(), -weight(), 1e-9);
  EXPECT_NEAR(balance.supports.z(), weight(), 0.01 * weight());
  EXPECT_LT(balance.unbalanced().norm(), 0.01 * weight());
  EXPECT_EQ(balance.fixed, Vec3::Zero());
  EXPECT_GT(lowest(pipeline.tissue()), -0.05 * 0.01);
  EXPECT_LT(lowest(pipeline.tissue()), 0.05 * 0.01);
}

TEST_P(LyingBlock, StaysWhereItLies) {
  Pipeline pipeline(lying(), solver(), {}, {table()});
  pipeline.settle();
  const Vec3 before = pipeline.tissue().vertices().back();
  for (int time = 0; time < 5; ++time) pipeline.settle();
  EXPECT_LT((pipeline.tissue().vertices().back() - before).norm(), 0.01 * 0.01);
}

// The same as a block that lies on a slope.
TEST_P(LyingBlock, FrictionHoldsItOnASlope) {
  const double angle = std::atan(0.25);
  const Vec3 gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  Pipeline pipeline(lying(gravity), solver(), {}, {table(0.5)});
  pipeline.settle();
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * weight());
  EXPECT_NEAR(balance.supports.x(), -weight() * std::sin(angle), 0.02 * weight());
  EXPECT_LT(greatestDisplacement(pipeline.tissue()), 0.01);
}

TEST_P(LyingBlock, HandsWhatAToolPressesToItsSupport) {
  Pipeline pipeline(lying(), solver(), {probe()}, {table()});
  pipeline.settle();
  walk(pipeline, -0.002, 0.004);
  const ForceBalance balance = pipeline.forceBalance();
  const double pressed_by = -balance.tools.z();
  EXPECT_GT(pressed_by, 0.05);
  EXPECT_NEAR(balance.supports.z(), weight() + pressed_by, 0.02 * weight());
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * (weight() + pressed_by));
  EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.05 * 0.01);
  EXPECT_GT(lowest(pipeline.tissue()), -0.05 * 0.01);
  walk(pipeline, 0.004, -0.002);
  EXPECT_NEAR(pipeline.forceBalance().supports.z(), weight(), 0.02 * weight());
  EXPECT_EQ(pipeline.forceBalance().tools, Vec3::Zero());
}

TEST_P(LyingBlock, SlidesWhenAToolPushesHarderThanFrictionHolds) {
  Pipeline pipeline(lying(), solver(), {withFriction(0.0, toolOf(boxOf(Vec3(0.01, 0.1, 0.02))))},
                    {table(0.2)});
  pipeline.settle();
  const Vec3 beside(-0.007, kMiddle, 0.02);
  walk(pipeline, {beside}, {beside + Vec3(0.012, 0.0, 0.0)}, 0.001);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_NEAR(balance.tools.x(), 0.2 * weight(), 0.1 * 0.2 * weight());
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * weight());
  const Lattice& lattice = pipeline.tissue().lattice();
  const int far = lattice.node(6, 3, 0);
  EXPECT_GT(pipeline.tissue().state().displacement[at(far)].x(), 0.002);
}

INSTANTIATE_TEST_SUITE_P(Method, LyingBlock, ::testing::Values("layered", "newton"),
                         [](const auto& row) { return std::string(row.param); });

TEST(Supports, BoxBearsAFixedBlocksOverhang) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.06, 0.02, 0.02);
  tissue.spacing = 0.01;
  tissue.material.young_modulus = 5e4;
  tissue.gravity = Vec3(0.0, 0.0, -9.81);
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)});
  const SupportConfig rest = {"rest", boxOf(Vec3(0.02, 0.04, 0.01), Vec3(0.06, 0.01, -0.005)), 0.3};
  Pipeline hangs(tissue, {}, {}, {});
  Pipeline lies(tissue, {}, {}, {rest});
  hangs.settle();
  lies.settle();
  const int tip = lies.tissue().lattice().node(6, 1, 0);
  EXPECT_LT(hangs.tissue().nodePosition(tip).z(), -0.001);
  EXPECT_GT(lies.tissue().nodePosition(tip).z(), -0.05 * 0.01);
  const ForceBalance balance = lies.forceBalance();
  EXPECT_GT(balance.supports.z(), 0.02);
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * balance.weight.norm());
}

// A support from above that stands in the tissue where that is at rest.
SolveStatus settledBelow(double height, double& top) {
  ToolShape ceiling = planeOf(false);
  ceiling.pose.translation().z() = height;
  Pipeline pipeline(block(), {}, {}, {{"ceiling", ceiling, 0.0}});
  const SolveStatus status = pipeline.settle().status;
  EXPECT_EQ(pipeline.tissue().lastReport().status, status);
  top = pipeline.tissue().vertices().front().z();
  for (const Vec3& vertex : pipeline.tissue().vertices()) top = std::max(top, vertex.z());
  return status;
}

TEST(Supports, WhatStaysThroughOneIsToldAsUnconverged) {
  double top = 0.0;
  EXPECT_EQ(settledBelow(0.95 * kTop, top), SolveStatus::kOk);
  EXPECT_LT(top, 0.95 * kTop + 0.05 * kSpacing);
  const SolveStatus status = settledBelow(0.2 * kTop, top);
  EXPECT_TRUE(status == SolveStatus::kUnconverged || top < 0.2 * kTop + 0.25 * kSpacing) << top;
}

// A saved state has no touches: what it lies on bears it, with friction, before a load comes.
TEST(Supports, OfALoadedStateHoldByFriction) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.05, 0.05, 0.03);
  tissue.spacing = 0.01;
  tissue.material.young_modulus = 14385.0;
  tissue.material.poisson_ratio = 0.4;
  tissue.gravity = Vec3(0.0, 0.0, -9.81);
  LoadStep aside;
  aside.patches.emplace_back();
  aside.patches.front().name = "aside";
  aside.patches.front().box = Box(Vec3(0.02, 0.02, 0.03), Vec3(0.03, 0.03, 0.03));
  aside.patches.front().force = Vec3(0.02, 0.0, 0.05);
  Pipeline goes_on(tissue, {}, {}, {{"table", planeOf(true), 0.5}});
  goes_on.settle();
  const std::string lying = goes_on.tissue().savedState();
  goes_on.load(aside);
  const double way = greatestDisplacement(goes_on.tissue());
  const std::string pulled = goes_on.tissue().savedState();
  for (const std::string& state : {lying, pulled}) {
    Pipeline loaded(tissue, {}, {}, {{"table", planeOf(true), 0.5}});
    EXPECT_EQ(loaded.loadState(state).status, SolveStatus::kOk);
    const ForceBalance balance = loaded.forceBalance();
    EXPECT_LT(balance.unbalanced().norm(), 0.02 * balance.weight.norm());
    EXPECT_LT(balance.supports.normalized().head<2>().norm(), 0.5);
    loaded.load(aside);
    EXPECT_EQ(loaded.tissue().lastReport().status, SolveStatus::kOk);
    EXPECT_NEAR(greatestDisplacement(loaded.tissue()), way, 0.1 * way);
  }
}

// What hovers is held by nothing; what lies is.
TEST(Supports, HoldPiecesThatTheyTouchFromBeingDropped) {
  const auto across = [](int axis, double place) {
    std::vector<Vec3> corners;
    for (const auto& [a, b] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
      Vec3 corner = Vec3::Constant(place);
      corner[(axis + 1) % 3] = a;
      corner[(axis + 2) % 3] = b;
      corners.push_back(corner);
    }
    return corners;
  };
  for (const bool lies : {false, true}) {
    TissueConfig tissue = block("elastic", 0.01);
    tissue.fixed.clear();
    tissue.free_pieces = FreePieces::kDrop;
    if (lies) tissue.gravity = Vec3(0.0, 0.0, -9.81);
    SupportConfig table{"table", planeOf(true), 1.0};
    table.shape.pose.translation().z() = lies ? 0.0 : -0.002;
    Pipeline pipeline(tissue, {}, {}, {table});
    pipeline.settle();
    pipeline.cut(across(2, 0.025));
    EXPECT_TRUE(pipeline.tissue().droppedPieces().size() == (lies ? 1U : 0U)) << lies;
    pipeline.cut(across(1, 0.005));
    pipeline.cut(across(0, 0.025));
    EXPECT_EQ(pipeline.tissue().droppedPieces().size(), lies ? 1U : 0U) << lies;
    EXPECT_EQ(pipeline.tissue().pieces().size(), lies ? 4U : 8U) << lies;
  }
}

}  // namespace
}  // namespace robot_tissue::test_supports
