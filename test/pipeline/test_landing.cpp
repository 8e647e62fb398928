// What nothing holds, where no time passes: it hangs until it is settled, and then it lies on what
// is below it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "../core/mesh_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_landing {
namespace {

constexpr double kStep = 0.01;     // spacing (m)
constexpr double kGravity = 9.81;  // m/s^2
const double kWeight = kGravity * 1000.0 * kWidth * kWidth * kTop;

TissueConfig loose() {
  TissueConfig tissue = block("elastic", kStep);
  tissue.fixed.clear();
  tissue.gravity = Vec3(0.0, 0.0, -kGravity);
  return tissue;
}

// Its top a plane at that height, the ground below it solid.
SupportConfig tableAt(double height, double friction = 0.3) {
  ToolShape plane;
  plane.type = ToolShape::Type::kPlane;
  plane.pose.translation().z() = height;
  return {"table", plane, friction};
}

double lowest(const Tissue& tissue) { return tissue.bounds().min().z(); }

class Above : public ::testing::TestWithParam<double> {};

TEST_P(Above, ABlockLiesAsOneThatWasOnTheTable) {
  Pipeline pipeline(loose(), {}, {}, {tableAt(-GetParam())});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_NEAR(balance.supports.z(), kWeight, 0.01 * kWeight);
  EXPECT_LT(balance.unbalanced().norm(), 0.01 * kWeight);
  Pipeline lying(loose(), {}, {}, {tableAt(0.0)});
  lying.settle();
  EXPECT_NEAR(lowest(pipeline.tissue()), -GetParam(), 0.03 * kStep);
  const double height = pipeline.tissue().bounds().sizes().z();
  EXPECT_NEAR(height, lying.tissue().bounds().sizes().z(), 0.03 * kStep);
  const Tissue::Displacements before = pipeline.tissue().displacements();
  pipeline.settle();
  EXPECT_LT((before->back() - pipeline.tissue().displacements()->back()).norm(), 0.01 * kStep);
}

INSTANTIATE_TEST_SUITE_P(M, Above, ::testing::Values(0.004, 0.03, 1.0));

TEST(Landing, ABallComesToLieOnTheTableThatItTouches) {
  constexpr double kBall = 0.03;
  TissueConfig tissue = loose();
  tissue.mesh = std::make_shared<const TriangleMesh>(sphereMesh(kBall, 3));
  Pipeline pipeline(tissue, {}, {}, {tableAt(-kBall)});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_NEAR(balance.supports.z(), -balance.weight.z(), 0.02 * -balance.weight.z());
  EXPECT_NEAR(lowest(pipeline.tissue()), -kBall, 0.05 * kStep);
  // Hertz has its weight press it 5 mm flat.
  EXPECT_NEAR(pipeline.tissue().bounds().sizes().z(), 2.0 * kBall - 0.005, 0.005);
}

TEST(Landing, ABlockWithMostOfItBeyondAnEdgeFallsOffIt) {
  const SupportConfig ledge = {"ledge", boxOf(Vec3(0.1, 0.3, 0.02), Vec3(0.09, kMiddle, -0.01)),
                               0.3};
  Pipeline pipeline(loose(), {}, {}, {ledge, tableAt(-0.1)});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  EXPECT_NEAR(lowest(pipeline.tissue()), -0.1, 0.05 * kStep);
  EXPECT_LT(pipeline.forceBalance().unbalanced().norm(), 0.02 * kWeight);
  EXPECT_EQ(pipeline.tissue().lastReport().inverted_cells, 0);
}

TEST(Landing, WhatSlidesWithoutEndStaysWhereItWas) {
  SupportConfig slope = tableAt(0.0, 0.3);
  slope.shape.pose.linear() = Eigen::AngleAxisd(std::atan(0.6), Vec3::UnitY()).toRotationMatrix();
  Pipeline pipeline(loose(), {}, {}, {slope});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kUnconverged);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST(Landing, WhatFallsAndSlidesWithoutEndIsUnconverged) {
  SupportConfig slope = tableAt(-0.05, 0.1);
  slope.shape.pose.linear() = Eigen::AngleAxisd(std::atan(0.6), Vec3::UnitY()).toRotationMatrix();
  Pipeline pipeline(loose(), {}, {}, {slope});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kUnconverged);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// A cube of two cells, borne up to `edge`; its middle is at 0.01 m.
std::unique_ptr<Pipeline> cubeOn(double edge) {
  TissueConfig tissue = loose();
  tissue.shape.max() = Vec3::Constant(0.02);
  tissue.material.young_modulus = 5.3e4;
  tissue.material.poisson_ratio = 0.25;
  const Vec3 size(0.022, 0.04, 0.01);
  const SupportConfig ledge = {
      "ledge", boxOf(size, Vec3(edge - 0.5 * size.x(), 0.01, -0.5 * size.z())), 0.8};
  return std::make_unique<Pipeline>(tissue, SolverConfig(), std::vector<ToolGeometry>(),
                                    std::vector<SupportConfig>{ledge});
}

void expectLies(const Pipeline& pipeline) {
  EXPECT_LT(greatestDisplacement(pipeline.tissue()), 0.1 * kStep);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_NEAR(balance.supports.z(), -balance.weight.z(), 0.02 * -balance.weight.z());
}

// Solves that go astray throw it off the edge.
TEST(Landing, ACubeThatAnEdgeBearsStaysOnIt) {
  const auto pipeline = cubeOn(0.0135);
  EXPECT_EQ(pipeline->settle().status, SolveStatus::kOk);
  expectLies(*pipeline);
}

// On two millimeters solves end or not by their rounding.
TEST(Landing, ACubeThatAnEdgeJustBearsIsNeverThrownOffUntold) {
  for (const double edge : {0.0118, 0.0119, 0.012, 0.0121}) {
    const auto pipeline = cubeOn(edge);
    if (pipeline->settle().status == SolveStatus::kOk) {
      expectLies(*pipeline);
    } else {
      EXPECT_EQ(pipeline->tissue().lastReport().status, SolveStatus::kUnconverged);
      EXPECT_EQ(greatestDisplacement(pipeline->tissue()), 0.0);
    }
  }
}

// Its wall would be missing on the way.
TEST(Landing, TissueWithAMembraneHangs) {
  constexpr double kBall = 0.03;
  TissueConfig tissue = loose();
  tissue.mesh = std::make_shared<const TriangleMesh>(sphereMesh(kBall, 3));
  MembraneConfig wall;
  wall.name = "wall";
  wall.thickness = 0.001;
  wall.young_modulus = 5e4;
  tissue.membranes.push_back(wall);
  Pipeline pipeline(tissue, {}, {}, {tableAt(-0.1)});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST(Landing, WithNothingBelowItTissueHangs) {
  const SupportConfig aside = {"aside", boxOf(Vec3(0.1, 0.1, 0.02), Vec3(0.5, 0.0, -0.2)), 0.3};
  Pipeline pipeline(loose(), {}, {}, {aside});
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
  EXPECT_LT(pipeline.forceBalance().weight.norm(), 1e-9 * kWeight);
}

// Fixed at its top, the lower half is cut off.
class CutOff : public ::testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<Pipeline> hung(const std::vector<SupportConfig>& supports) {
    TissueConfig tissue = loose();
    tissue.fixed.push_back({Vec3(-1.0, -1.0, kTop - 1e-6), Vec3(1.0, 1.0, 1.0)});
    SolverConfig solver;
    solver.method = GetParam();
    return std::make_unique<Pipeline>(tissue, solver, std::vector<ToolGeometry>(), supports);
  }
  static CutReport cutInTwo(Pipeline& pipeline) {
    constexpr double kHeight = 0.015;
    return pipeline.cut({Vec3(-1.0, -1.0, kHeight), Vec3(1.0, -1.0, kHeight),
                         Vec3(1.0, 1.0, kHeight), Vec3(-1.0, 1.0, kHeight)});
  }
};

TEST_P(CutOff, HangsWithoutASupport) {
  const auto held = hung({});
  Pipeline& pipeline = *held;
  pipeline.settle();
  const Vec3 before = pipeline.tissue().nodePosition(0);
  const CutReport cut = cutInTwo(pipeline);
  EXPECT_EQ(cut.pieces, 2);
  EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
  EXPECT_EQ(pipeline.tissue().nodePosition(0), before);
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  EXPECT_EQ(pipeline.tissue().nodePosition(0), before);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_GT(-balance.weight.z(), 0.5 * kWeight);
  EXPECT_LT(-balance.weight.z(), 0.7 * kWeight);
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * kWeight);
}

TEST_P(CutOff, LiesOnTheTableOnceSettled) {
  constexpr double kTable = -0.02;
  const auto held = hung({tableAt(kTable)});
  Pipeline& pipeline = *held;
  pipeline.settle();
  EXPECT_EQ(cutInTwo(pipeline).solve.status, SolveStatus::kOk);
  EXPECT_GT(lowest(pipeline.tissue()), -0.1 * kStep);
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  EXPECT_NEAR(lowest(pipeline.tissue()), kTable, 0.03 * kStep);
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_NEAR(-balance.weight.z(), kWeight, 1e-6 * kWeight);
  EXPECT_NEAR(balance.supports.z(), 0.4 * kWeight, 0.1 * kWeight);
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * kWeight);
}

// Thinner than a fifth of a spacing, and four high, so that it does not stand.
TEST(Landing, ASliceThatIsCutOffTopples) {
  TissueConfig tissue = loose();
  tissue.material.young_modulus = 5e4;
  Pipeline pipeline(tissue, {}, {}, {tableAt(0.0)});
  pipeline.settle();
  const double place = kWidth - 0.0022;
  const CutReport cut = pipeline.cut({Vec3(place, -1.0, -1.0), Vec3(place, 1.0, -1.0),
                                      Vec3(place, 1.0, 1.0), Vec3(place, -1.0, 1.0)});
  EXPECT_EQ(cut.pieces, 2);
  EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
  EXPECT_LT(pipeline.forceBalance().unbalanced().norm(), 0.02 * kWeight);
  const std::vector<TissuePiece> pieces = pipeline.tissue().pieces();
  EXPECT_GT(pieces[0].center.z(), 0.4 * kTop);
  EXPECT_LT(pieces[1].center.z(), 0.25 * kTop);
  EXPECT_EQ(pipeline.undo(1).status, SolveStatus::kOk);
  EXPECT_EQ(pipeline.tissue().state().pieces, 1);
}

// Tissue would fall through tissue.
TEST(Landing, ALooseBlocksUpperHalfStaysOnTheLower) {
  Pipeline pipeline(loose(), {}, {}, {tableAt(-0.01)});
  pipeline.settle();
  constexpr double kHeight = 0.008;
  pipeline.cut({Vec3(-1.0, -1.0, kHeight), Vec3(1.0, -1.0, kHeight), Vec3(1.0, 1.0, kHeight),
                Vec3(-1.0, 1.0, kHeight)});
  ASSERT_EQ(pipeline.tissue().state().pieces, 2);
  const double top = pipeline.tissue().bounds().max().z();
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  EXPECT_NEAR(pipeline.tissue().bounds().max().z(), top, 0.01 * kStep);
  EXPECT_NEAR(lowest(pipeline.tissue()), -0.01, 0.03 * kStep);
}

INSTANTIATE_TEST_SUITE_P(Method, CutOff, ::testing::Values("layered", "newton", "vbd"),
                         [](const auto& row) { return std::string(row.param); });

}  // namespace
}  // namespace robot_tissue::test_landing
