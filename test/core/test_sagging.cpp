// What sags far under its own weight, turned by up to a right angle and more, against `newton`.
#include <gtest/gtest.h>

#include <array>
#include <ostream>
#include <string>

#include "layered_fixtures.h"
#include "solvers/multigrid/level/cell_relief.h"

namespace robot_tissue::test_sagging {
namespace {

struct Bar {
  const char* name;
  std::array<int, 3> cells;
  double spacing;  // m
  double gravity;  // m/s^2, downwards
  double poisson_ratio;
};

std::ostream& operator<<(std::ostream& out, const Bar& bar) { return out << bar.name; }

// Fixed at its face x = 0; E 10 kPa.
TissueConfig configOf(const Bar& bar) {
  TissueConfig config = blockOf(bar.cells[0], bar.cells[1], bar.cells[2], bar.spacing);
  config.model = "elastic";
  config.material.poisson_ratio = bar.poisson_ratio;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, bar.cells[1], bar.cells[2]}));
  config.gravity = Vec3(0.0, 0.0, -bar.gravity);
  return config;
}

class Sagging : public testing::TestWithParam<Bar> {};

TEST_P(Sagging, BalancesInOneGoAsNewtonSays) {
  const TissueConfig config = configOf(GetParam());
  ElasticBlock exact(config);
  ASSERT_EQ(exact.solve({}).status, SolveStatus::kOk);
  for (const double tolerance : {0.1, 0.01, 1e-4}) {
    LayeredBlock block(config, within(tolerance));
    const SolveReport report = block.solve({}, nodesOf(block.lattice));
    EXPECT_EQ(report.status, SolveStatus::kOk) << tolerance;
    EXPECT_LE(report.error_estimate, tolerance);
    EXPECT_LE(report.iterations, 400) << tolerance;
    EXPECT_LE(errorOf(block.lattice, {}, block.state.displacement, exact.state.displacement),
              tolerance);
    const SolveReport again = block.solve({}, nodesOf(block.lattice));
    EXPECT_EQ(again.status, SolveStatus::kOk) << tolerance;
    EXPECT_LE(again.iterations, 20) << tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(Bars, Sagging,
                         testing::Values(Bar{"short", {5, 1, 1}, 0.01, 9.81, 0.45},
                                         Bar{"short_fine", {10, 2, 2}, 0.005, 9.81, 0.45},
                                         Bar{"light", {7, 1, 1}, 0.01, 1.0, 0.45},
                                         Bar{"slender", {10, 1, 1}, 0.01, 9.81, 0.3},
                                         Bar{"thick", {20, 4, 4}, 0.005, 9.81, 0.49},
                                         Bar{"long", {30, 6, 6}, 0.005, 9.81, 0.45},
                                         Bar{"sheet", {10, 10, 1}, 0.01, 9.81, 0.45}),
                         [](const auto& bar) { return std::string(bar.param.name); });

// What loads bend further is found in few cycles from there.
TEST(SaggingLoads, FollowPatches) {
  const TissueConfig config = configOf({"", {20, 4, 4}, 0.005, 9.81, 0.45});
  LayeredBlock block(config, within(0.01));
  ElasticBlock exact(config);
  ASSERT_EQ(block.solve({}, nodesOf(block.lattice)).status, SolveStatus::kOk);
  ASSERT_EQ(exact.solve({}).status, SolveStatus::kOk);
  LoadingPatch end;
  end.name = "end";
  end.nodes = block.lattice.nodesIn(nodeBox(config, {20, 0, 0}, {20, 4, 4}));
  end.drive = LoadingPatch::Drive::kForce;
  end.center = Vec3(0.1, 0.01, 0.01);
  for (const double force : {0.02, 0.04, 0.06}) {
    end.force = Vec3(0.0, 0.5 * force, force);
    const SolveReport report = block.solve({end});
    ASSERT_EQ(exact.solve({end}).status, SolveStatus::kOk);
    EXPECT_EQ(report.status, SolveStatus::kOk) << force;
    EXPECT_LE(report.iterations, 60) << force;
    EXPECT_LE(
        errorOf(block.lattice, block.patches, block.state.displacement, exact.state.displacement),
        0.01);
  }
}

const Eigen::Matrix3d kStretch = Vec3(1.3, 0.8, 1.05).asDiagonal();
Eigen::Matrix3d turned(double angle) {
  return Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
}

// F of a coarse cell of finer ones that are all alike is theirs.
TEST(CellRelief, LeavesWhatIsEvenAsItIs) {
  StretchMeans means(LevelGrid({3, 3, 3}));
  const Eigen::Matrix3d strain = turned(2.0) * kStretch;
  for (const int k : {0, 1}) means.add({k, k, 0}, strain, 1.0 + k);
  EXPECT_TRUE(relievedStrain(strain, means.squareAt({0, 0, 0})).isApprox(strain, 1e-6));
}

// Halves turned to and fro are not squeezed, their chord is.
TEST(CellRelief, ChordsOfWhatIsBentAreAsLongAsTheirArcs) {
  StretchMeans means(LevelGrid({3, 3, 3}));
  const Eigen::Matrix3d to = turned(0.5) * kStretch, fro = turned(-0.5) * kStretch;
  means.add({0, 0, 0}, to, 1.0);
  means.add({1, 0, 0}, fro, 1.0);
  const Eigen::Matrix3d chord = turned(1.0) * (0.5 * (to + fro));
  EXPECT_LT(chord.determinant(), 0.95 * kStretch.determinant());
  const Eigen::Matrix3d relieved = relievedStrain(chord, means.squareAt({0, 0, 0}));
  EXPECT_NEAR(relieved.determinant(), kStretch.determinant(), 1e-6);
}

TEST(CellRelief, FlatCellsHaveNone) {
  const Eigen::Matrix3d flat = Vec3(1.0, 1.0, 0.01).asDiagonal();
  EXPECT_EQ(relievedStrain(flat, Eigen::Matrix3d::Identity()), flat);
  const Eigen::Matrix3d over = Vec3(1.0, 1.0, -1.0).asDiagonal();
  EXPECT_EQ(relievedStrain(over, Eigen::Matrix3d::Identity()), over);
}

}  // namespace
}  // namespace robot_tissue::test_sagging
