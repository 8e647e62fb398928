// What is taken back under loads leaves the loads as they are.
#include <gtest/gtest.h>

#include "block_fixtures.h"
#include "suture_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_undo_under_loads {
namespace {

TissueConfig tearing() {
  TissueConfig config = withFixedBottom(blockOf(8, 4, 3, 0.01));
  config.model = "elastic";
  config.material.poisson_ratio = 0.3;
  config.material.tear_stretch = 1.3;
  return config;
}

LoadStep lift(const TissueConfig& config, const std::string& name, int from, double way) {
  return loadOf(
      {displacedPatch(name, nodeBox(config, {from, 0, 3}, {from + 2, 4, 3}), {0, 0, way})});
}

TEST(UndoUnderLoads, TearsOfTwoLoadsAreTwoChangesAndLeaveTheLoads) {
  const TissueConfig config = tearing();
  Tissue tissue(config, {});
  tissue.load(lift(config, "a", 0, 0.012));
  const int torn_by_a = tissue.state().springs_cut;
  ASSERT_GT(torn_by_a, 0);
  EXPECT_EQ(tissue.undoable(), 1);
  tissue.load(lift(config, "b", 6, 0.012));
  ASSERT_GT(tissue.state().springs_cut, torn_by_a);
  EXPECT_EQ(tissue.undoable(), 2);
  for (const int left : {torn_by_a, 0}) {
    tissue.undo(1);
    EXPECT_EQ(tissue.state().springs_cut, left);
    ASSERT_EQ(tissue.namedPatches(), 2U);
    for (const LoadingPatch& patch : tissue.patches()) {
      EXPECT_EQ(patch.displacement.front(), Vec3(0, 0, 0.012)) << patch.name;
    }
  }
  EXPECT_EQ(tissue.undoable(), 0);
}

// It is whole, as was asked for, and tears again with the next solve. With the load of before the
// tear (small steps) the shape is that of then; else it is balanced anew.
TEST(UndoUnderLoads, OfATearUnderItsLoadMendsItAndTellsThatItTearsAgain) {
  const TissueConfig config = tearing();
  for (const double step : {0.012, 0.0005}) {
    Tissue tissue(config, {});
    double way = 0.0;
    while (tissue.undoable() == 0 && way < 0.02) tissue.load(lift(config, "a", 0, way += step));
    const int torn = tissue.state().springs_cut;
    ASSERT_GT(torn, 0);
    EXPECT_FALSE(tissue.isOverstretched());
    EXPECT_EQ(tissue.undo(1).status, SolveStatus::kOk);
    EXPECT_EQ(tissue.state().springs_cut, 0);
    EXPECT_EQ(tissue.undoable(), 0);
    EXPECT_TRUE(tissue.isOverstretched());
    EXPECT_EQ(tissue.patches()[0].displacement.front(), Vec3(0, 0, way));
    tissue.settle();
    EXPECT_GT(tissue.state().springs_cut, 0);
    EXPECT_EQ(tissue.undoable(), 1);
  }
}

TEST(UndoUnderLoads, WhatHoldsOnceTheLoadIsGoneIsNotStretched) {
  const TissueConfig config = tearing();
  Tissue tissue(config, {});
  tissue.load(lift(config, "a", 0, 0.012));
  tissue.release({"a"});
  tissue.undo(1);
  EXPECT_EQ(tissue.state().springs_cut, 0);
  EXPECT_FALSE(tissue.isOverstretched());
}

// A blade that goes on after the loads became others.
TEST(UndoUnderLoads, AStrokeLeavesALoadThatCameWhileItLasted) {
  TissueConfig config = tearing();
  config.material.tear_stretch = 0.0;
  Tissue tissue(config, {});
  const auto strip = [](double from, double to) {
    const Vec3 a(0.035, -1.0, from), b(0.035, 1.0, from), c(0.035, 1.0, to), d(0.035, -1.0, to);
    return std::vector<CutTriangle>{{a, b, c}, {a, c, d}};
  };
  ASSERT_GT(tissue.cutAlong(strip(0.02, 0.04)).springs_cut, 0);
  tissue.load(lift(config, "a", 6, 0.002));
  ASSERT_GT(tissue.cutAlong(strip(0.01, 0.02), Stroke::kGoesOn).springs_cut, 0);
  ASSERT_EQ(tissue.undoable(), 1);
  tissue.undo(1);
  EXPECT_EQ(tissue.state().springs_cut, 0);
  EXPECT_EQ(tissue.namedPatches(), 1U);
}

}  // namespace
}  // namespace robot_tissue::test_undo_under_loads
