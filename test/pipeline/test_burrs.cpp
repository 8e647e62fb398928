// Tools that drill: what goes, whatever the updates, and the way back.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_burrs {
namespace {

constexpr double kBurrRadius = 0.008;
constexpr double kFine = 0.002;  // m

ToolGeometry burrOf(const ToolShape& shape) {
  ToolGeometry tool = toolOf(shape, "burr");
  tool.role = toolRole("burr");
  return tool;
}

ToolGeometry ball(double radius = kBurrRadius) {
  ToolShape sphere;
  sphere.radius = radius;
  return burrOf(sphere);
}

ToolShape drill(double radius, double length) {
  ToolShape cylinder;
  cylinder.type = ToolShape::Type::kCylinder;
  cylinder.radius = radius;
  cylinder.length = length;
  return cylinder;
}

// Along the block below its top, from outside to outside.
const Vec3 kFrom(-0.02, 0.031, kTop - 0.003);
const Vec3 kTo(0.08, 0.028, kTop - 0.004);

double go(Pipeline& pipeline, const Vec3& from, const Vec3& to, int updates) {
  double volume = 0.0;
  for (int i = 0; i <= updates; ++i) {
    volume += pipeline.step(at({from + (to - from) * i / updates})).volume_removed;
  }
  return volume;
}

double volumeOf(const Tissue& tissue) {
  double volume = 0.0;
  for (const TissuePiece& piece : tissue.pieces()) volume += piece.volume;
  return volume;
}

TEST(Burr, SameCellsInOneTenAndAHundredUpdates) {
  std::vector<std::vector<std::uint8_t>> taken;
  std::vector<double> volume;
  for (const int updates : {1, 10, 100}) {
    Pipeline pipeline(block(), methodOf("elastic"), {ball()});
    volume.push_back(go(pipeline, kFrom, kTo, updates));
    taken.push_back(pipeline.tissue().state().taken);
    EXPECT_NEAR(volumeOf(pipeline.tissue()), kWidth * kWidth * kTop - volume.back(), 1e-12);
    EXPECT_FALSE(pipeline.report().too_fast);
  }
  EXPECT_GT(volume[0], 0.0);
  EXPECT_EQ(taken[1], taken[0]);
  EXPECT_EQ(taken[2], taken[0]);
}

// Hung up at its bottom the tissue gives way as it is drilled.
TEST(Burr, SameCellsInTissueThatGivesWay) {
  TissueConfig hanging = block();
  hanging.gravity = Vec3(0.0, 0.0, 9.81);
  std::vector<std::vector<std::uint8_t>> taken;
  for (const int updates : {1, 7}) {
    Pipeline pipeline(hanging, methodOf("elastic"), {ball()});
    pipeline.settle();
    go(pipeline, kFrom, kTo, updates);
    taken.push_back(pipeline.tissue().state().taken);
  }
  EXPECT_EQ(taken[1], taken[0]);
}

// A hole of the radius R and the depth d is off by what half cells at its wall and bottom make: the
// error of counting cells in a circle is of some 1 / R^2 cells on the mean.
TEST(Burr, DrillsAHoleOfItsVolume) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.04, 0.04, 0.02);
  tissue.spacing = kFine;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back(bottomOf(tissue.shape));
  const double radius = 0.0081, depth = 0.012;
  Pipeline pipeline(tissue, methodOf("elastic"), {burrOf(drill(radius, 0.03))});
  const Vec3 above(0.0203, 0.0198, 0.02 + 0.015 + 0.001);
  // The tip comes to half a stride below `depth`, so that its cells are covered for certain.
  const double volume = go(pipeline, above, above - Vec3(0.0, 0.0, depth + 0.00125), 13);
  const double exact = M_PI * radius * radius * depth;
  EXPECT_NEAR(volume, exact, 0.05 * exact);
  EXPECT_EQ(pipeline.report().tools.front().force_on_tool, Vec3::Zero());
  EXPECT_EQ(pipeline.report().tools.front().contacts, 0);
}

TEST(Burr, AStretchIsTakenBackAsOneBitForBit) {
  Pipeline pipeline(block(), methodOf("elastic"), {ball()});
  const std::uint64_t before = pipeline.tissue().stateHash();
  go(pipeline, kFrom, kTo, 20);
  EXPECT_EQ(pipeline.tissue().undoable(), 1);
  const std::uint64_t once = pipeline.tissue().stateHash();
  go(pipeline, kTo, kTo + Vec3(0.0, 0.0, -0.01), 3);
  go(pipeline, kTo + Vec3(0.0, 0.0, -0.01), kFrom + Vec3(0.0, 0.0, -0.01), 20);
  EXPECT_EQ(pipeline.tissue().undoable(), 2);
  pipeline.undo(1);
  EXPECT_EQ(pipeline.tissue().stateHash(), once);
  pipeline.undo(1);
  EXPECT_EQ(pipeline.tissue().stateHash(), before);
}

TEST(Burr, TakesNotAllOfTheTissueAndSaysSo) {
  Pipeline pipeline(ridge(), methodOf("elastic"), {ball(0.1)});
  pipeline.step(at({Vec3(0.015, 0.005, 0.2)}));
  const double volume = volumeOf(pipeline.tissue());
  pipeline.step(at({Vec3(0.015, 0.005, 0.0)}));
  EXPECT_EQ(pipeline.report().would_take_all, std::vector<std::size_t>{0});
  const double left = volumeOf(pipeline.tissue());
  EXPECT_GT(left, 0.0);
  EXPECT_LT(left, volume);
  for (int i = 0; i < 2; ++i) pipeline.step(at({Vec3(0.02, 0.005, 0.0)}));  // on, and stands
  EXPECT_EQ(pipeline.report().would_take_all, std::vector<std::size_t>{0});
  EXPECT_EQ(volumeOf(pipeline.tissue()), left);
  pipeline.reset();
  EXPECT_EQ(volumeOf(pipeline.tissue()), volume);
  EXPECT_TRUE(pipeline.report().would_take_all.empty());
}

TEST(Burr, BesideToolsThatPressAndHoldAndOnATrial) {
  for (const std::string model : {"elastic", "six_spring"}) {
    for (const auto patch : {ToolConfig::Patch::kConforming, ToolConfig::Patch::kRigid}) {
      if (model == "six_spring" && patch != ToolConfig::Patch::kRigid) continue;
      ToolGeometry presses = probe();
      presses.patch = patch;
      Pipeline pipeline(block(model), methodOf(model), {ball(), presses});
      const Vec3 pressing(kMiddle, 0.02, kTop + kRadius - 0.003);
      pipeline.step(at({kFrom, pressing + Vec3(0.0, 0.0, 0.004)}));
      pipeline.step(at({kFrom, pressing}));
      pipeline.beginTrial();
      pipeline.step(at({kTo, pressing}));
      EXPECT_EQ(pipeline.report().volume_removed, 0.0);
      pipeline.undoTrial();
      double volume = 0.0;
      for (int i = 1; i <= 5; ++i) {
        volume += pipeline.step(at({kFrom + (kTo - kFrom) * i / 5.0, pressing})).volume_removed;
      }
      EXPECT_GT(volume, 0.0);
      pipeline.step(at({kTo, pressing + Vec3(0.0, 0.0, 0.004)}));
      EXPECT_NEAR(pipeline.report().tools.back().force_on_tool.norm(), 0.0, 1e-9);
    }
  }
}

TEST(Burr, NoForceDrivesIt) {
  Pipeline pipeline(block(), methodOf("elastic"), {ball()});
  pipeline.step(at({kFrom}));
  EXPECT_THROW(pipeline.push(0, Vec3(1.0, 0.0, 0.0)), InputError);
}

// What is done in between parts a stroke.
TEST(Burr, WhatGoesAfterAnUndoIsAChangeOfItsOwn) {
  Pipeline pipeline(block(), methodOf("elastic"), {ball()});
  const std::vector<Vec3> aside = {
      {0.052, -0.01, 0.02}, {0.052, 0.07, 0.02}, {0.052, 0.07, 0.06}, {0.052, -0.01, 0.06}};
  ASSERT_GT(pipeline.cut(aside).springs_cut, 0);
  const double depth = kTop - 0.003;
  ASSERT_GT(go(pipeline, Vec3(-0.02, kMiddle, depth), Vec3(0.012, kMiddle, depth), 8), 0.0);
  ASSERT_EQ(pipeline.tissue().undoable(), 2);
  pipeline.undo(1);
  double volume = 0.0;
  for (double x = 0.012; x < 0.02; x += 0.002) {
    volume += pipeline.step(at({Vec3(x, kMiddle, depth)})).volume_removed;
  }
  ASSERT_GT(volume, 0.0);
  EXPECT_EQ(pipeline.tissue().undoable(), 2);
  pipeline.undo(1);
  EXPECT_GT(pipeline.tissue().state().springs_cut, 0) << "the cut was taken back with it";
}

}  // namespace
}  // namespace robot_tissue::test_burrs
