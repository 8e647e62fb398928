// Tissue: loads and their increments, what is reported of them.
#include <gtest/gtest.h>

#include <cmath>

#include "tissue_fixtures.h"

namespace robot_tissue::test_tissue {
namespace {

constexpr double kSpacing = 0.005;
const TissueConfig kBlock = withFixedBottom(blockOf(20, 12, 8, kSpacing));
const Box kLeft = nodeBox(kBlock, {3, 4, 8}, {6, 8, 8});
const Box kRight = nodeBox(kBlock, {14, 4, 8}, {17, 8, 8});
const Vec3 kDown(0.0, 0.0, -3e-3);

TEST(Tissue, BeginsAtRest) {
  const Tissue tissue(kBlock, paperSolver());
  expectAtRest(tissue);
  EXPECT_TRUE(tissue.patches().empty());
  EXPECT_TRUE(tissue.isUntouched());
  EXPECT_GT(tissue.stepLength(), 0.0);
  EXPECT_LE(tissue.stepLength(), 0.5 * kSpacing);
}

TEST(Tissue, RefusesUnknownModelAndMethod) {
  TissueConfig config = kBlock;
  config.model = "jelly";
  std::string line = inputErrorOf([&] { const Tissue tissue(config, paperSolver()); });
  EXPECT_TRUE(isOneLine(line) && mentions(line, "tissue.model") && mentions(line, "jelly") &&
              mentions(line, "six_spring"))
      << line;
  SolverConfig solver;
  solver.method = "magic";
  line = inputErrorOf([&] { const Tissue tissue(kBlock, solver); });
  EXPECT_TRUE(isOneLine(line) && mentions(line, "solver.method") && mentions(line, "magic") &&
              mentions(line, "paper"))
      << line;
}

TEST(TissueLoad, ReachesTheWholeDisplacementInTheGivenIncrements) {
  Tissue tissue(kBlock, paperSolver());
  std::vector<double> depths;
  int called = 0;
  tissue.load(loadOf({displacedPatch("left", kLeft, kDown)}, 6),
              [&](int increment, int increments, const SolveReport& report) {
                EXPECT_EQ(increment, ++called);
                EXPECT_EQ(increments, 6);
                ASSERT_EQ(report.patches.size(), 1u);
                depths.push_back(report.patches[0].displacement.z());
                EXPECT_LT(report.patches[0].force.z(), 0.0);
              });
  ASSERT_EQ(depths.size(), 6u);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    EXPECT_NEAR(depths[i], kDown.z() * static_cast<double>(i + 1) / 6.0, 1e-15);
  }
  for (const int node : tissue.lattice().nodesIn(kLeft)) {
    EXPECT_EQ(tissue.state().displacement[at(node)], kDown);
  }
  EXPECT_EQ(tissue.namedPatches(), 1u);
  EXPECT_TRUE(tissue.isUntouched());  // by tools
}

TEST(TissueLoad, ChoosesIncrementsNoLongerThanTheMethodFollows) {
  Tissue tissue(kBlock, paperSolver());
  for (const double steps : {0.5, 1.0, 3.0, 3.5}) {
    const Vec3 way(0.0, 0.0, -steps * tissue.stepLength());
    EXPECT_EQ(reportsOf(tissue, loadOf({displacedPatch("left", kLeft, way)})).size(),
              at(static_cast<int>(std::ceil(steps))));
    tissue.reset();
  }
}

TEST(TissueLoad, ChoosesMoreIncrementsForMoreForce) {
  Tissue tissue(kBlock, paperSolver());
  const auto count = [&](double push) {
    tissue.reset();
    return reportsOf(tissue, loadOf({forcedPatch("left", kLeft, Vec3(0.0, 0.0, -push))})).size();
  };
  EXPECT_GE(count(1e-4), 1u);
  EXPECT_GT(count(2.0), count(1e-4));
}

TEST(TissueLoad, CountsDisplacementFromRest) {
  Tissue tissue(kBlock, paperSolver());
  tissue.load(loadOf({displacedPatch("left", kLeft, kDown)}));
  const auto reports = reportsOf(tissue, loadOf({displacedPatch("left", kLeft, 2.0 * kDown)}, 3));
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_LT((reports[0].patches[0].displacement - kDown * 4.0 / 3.0).norm(), 1e-15);
  EXPECT_LT((reports[2].patches[0].displacement - 2.0 * kDown).norm(), 1e-15);
  EXPECT_EQ(tissue.namedPatches(), 1u);
}

TEST(TissueLoad, CountsForceFromNoneAndGoesThereFromTheForceBefore) {
  Tissue tissue(kBlock, paperSolver());
  const Vec3 force(0.0, 0.0, -0.2);
  tissue.load(loadOf({forcedPatch("left", kLeft, force)}));
  const auto reports = reportsOf(tissue, loadOf({forcedPatch("left", kLeft, 2.0 * force)}, 4));
  ASSERT_EQ(reports.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 expected = force * (1.0 + 0.25 * static_cast<double>(i + 1));
    EXPECT_LT((reports[i].patches[0].force - expected).norm(), 1e-4 * force.norm());
  }
}

TEST(TissueLoad, ForceThenDisplacementOnTheSamePatch) {
  Tissue tissue(kBlock, paperSolver());
  const Vec3 force(0.0, 0.0, -0.3);
  auto reports = reportsOf(tissue, loadOf({forcedPatch("left", kLeft, force)}));
  EXPECT_LT((tissue.answerOf("left", reports.back()).force - force).norm(), 1e-5 * force.norm());
  const Vec3 reached = tissue.answerOf("left", reports.back()).displacement;
  ASSERT_LT(reached.z(), -1e-5);
  reports = reportsOf(tissue, loadOf({displacedPatch("left", kLeft, kDown)}, 2));
  EXPECT_LT((reports[0].patches[0].displacement - 0.5 * (reached + kDown)).norm(), 1e-12);
  EXPECT_LT((reports[1].patches[0].displacement - kDown).norm(), 1e-15);
  EXPECT_EQ(tissue.namedPatches(), 1u);
}

TEST(TissueLoad, DisplacementThenForceOnTheSamePatch) {
  Tissue tissue(kBlock, paperSolver());
  tissue.load(loadOf({displacedPatch("left", kLeft, kDown)}));
  const Vec3 force(0.02, 0.0, -0.1);
  const auto reports = reportsOf(tissue, loadOf({forcedPatch("left", kLeft, force)}));
  EXPECT_LT((reports.back().patches[0].force - force).norm(), 1e-5 * force.norm());
}

TEST(TissueLoad, SeveralPatchesStandTogether) {
  Tissue tissue(kBlock, paperSolver());
  const Vec3 force(0.0, 0.0, -0.2);
  tissue.load(loadOf({displacedPatch("left", kLeft, kDown)}));
  const auto reports = reportsOf(tissue, loadOf({forcedPatch("right", kRight, force)}));
  ASSERT_EQ(tissue.namedPatches(), 2u);
  const SolveReport& report = reports.back();
  ASSERT_EQ(report.patches.size(), 2u);
  EXPECT_LT((tissue.answerOf("left", report).displacement - kDown).norm(), 1e-15);
  EXPECT_LT((tissue.answerOf("right", report).force - force).norm(), 1e-5 * force.norm());
  EXPECT_EQ(tissue.patches()[0].name, "left");
  EXPECT_EQ(tissue.patches()[1].name, "right");
  EXPECT_EQ(tissue.answerOf("nobody", report).force, Vec3(Vec3::Zero()));
}

TEST(TissueLoad, FreeComponentLetsNodesSlide) {
  Tissue tissue(kBlock, paperSolver());
  PatchConfig plate = displacedPatch("left", kLeft, kDown);
  (*plate.displacement)[0] = std::nullopt;
  tissue.load(loadOf({plate}));
  ASSERT_EQ(tissue.namedPatches(), 1u);
  EXPECT_EQ(tissue.patches()[0].free_axis, (std::array<bool, 3>{{true, false, false}}));
  double slid = 0.0;
  for (const int node : tissue.lattice().nodesIn(kLeft)) {
    const Vec3& moved = tissue.state().displacement[at(node)];
    EXPECT_EQ(moved.y(), 0.0);
    EXPECT_EQ(moved.z(), kDown.z());
    slid = std::max(slid, std::abs(moved.x()));
  }
  EXPECT_GT(slid, 0.0);
}

TEST(TissueReport, VolumeIsThatOfRestAndFallsUnderAPress) {
  Tissue tissue(kBlock, paperSolver());
  EXPECT_NEAR(tissue.settle().volume_ratio, 1.0, 1e-12);
  double ratio = 1.0;
  for (const SolveReport& report :
       reportsOf(tissue, loadOf({displacedPatch("left", kLeft, kDown)}, 3))) {
    EXPECT_LT(report.volume_ratio, ratio);
    ratio = report.volume_ratio;
  }
  EXPECT_GT(ratio, 0.9);
  EXPECT_NEAR(ratio,
              enclosedVolume(tissue.surface(), tissue.vertices()) /
                  enclosedVolume(tissue.surface(), tissue.surface().rest),
              1e-12);
}

TEST(TissueReport, SaysWhenCellsAreTurnedInsideOut) {
  const TissueConfig column = withFixedBottom(blockOf(1, 1, 2));
  Tissue tissue(column, paperSolver());
  const Box top = nodeBox(column, {0, 0, 2}, {1, 1, 2});
  auto reports = reportsOf(tissue, loadOf({displacedPatch("top", top, Vec3(0, 0, -1e-3))}, 1));
  EXPECT_EQ(reports.back().status, SolveStatus::kOk);
  EXPECT_EQ(reports.back().inverted_cells, 0);
  reports = reportsOf(tissue, loadOf({displacedPatch("top", top, Vec3(0, 0, -0.019))}, 1));
  EXPECT_EQ(reports.back().status, SolveStatus::kInverted);
  EXPECT_GE(reports.back().inverted_cells, 1);
}

TEST(TissueReport, VerticesFollowTheNodes) {
  Tissue tissue(kBlock, paperSolver());
  tissue.load(loadOf({displacedPatch("left", kLeft, kDown)}));
  const TissueSurface& surface = tissue.surface();
  for (std::size_t vertex = 0; vertex < surface.rest.size(); ++vertex) {
    const int node = surface.carriers[vertex][0].node;
    EXPECT_EQ(tissue.vertices()[vertex],
              Vec3(surface.rest[vertex] + tissue.state().displacement[at(node)]));
  }
}

}  // namespace
}  // namespace robot_tissue::test_tissue
