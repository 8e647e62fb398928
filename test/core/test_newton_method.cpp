#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastic_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_newton_method {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kYoung = 1e4;  // Pa

LoadingPatch face(const Lattice& lattice, const TissueConfig& config, int axis, bool upper,
                  double displacement) {
  Box box = config.shape;
  (upper ? box.min() : box.max())[axis] = (upper ? box.max() : box.min())[axis];
  LoadingPatch patch = displaced(lattice.nodesIn(box), displacement * Vec3::Unit(axis));
  patch.name = upper ? "upper" : "lower";
  patch.free_axis.fill(true);
  patch.free_axis[at(axis)] = false;
  return patch;
}

class Uniaxial : public testing::TestWithParam<double> {};

TEST_P(Uniaxial, GivesYoungsModulusAndPoissonsRatioBackAlongEachAxis) {
  constexpr double kStrain = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    const TissueConfig config = elasticBlockOf(4, 3, 5, GetParam());
    ElasticBlock block(config);
    const Vec3 size = config.shape.max();
    const SolveReport report =
        block.solve({face(block.lattice, config, axis, false, 0.0),
                     face(block.lattice, config, axis, true, kStrain * size[axis])});
    ASSERT_EQ(report.status, SolveStatus::kOk);
    const double area = size.prod() / size[axis];
    EXPECT_NEAR(report.patches[1].force[axis], kYoung * area * kStrain,
                1e-3 * kYoung * area * kStrain);
    const int across = (axis + 1) % 3;
    const Vec3 widened = block.state.displacement.back() - block.state.displacement.front();
    EXPECT_NEAR(-widened[across] / (kStrain * size[across]), GetParam(), 1e-3 * GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Ratios, Uniaxial, testing::Values(0.25, 0.45, 0.49));

TEST(Newton, PatchTestGivesALinearFieldBackInside) {
  ElasticBlock block(elasticBlockOf(4, 4, 4, 0.45));
  Eigen::Matrix3d gradient;
  gradient << 1.1, 0.2, -0.05, 0.0, 0.9, 0.1, 0.05, -0.1, 1.05;
  LatticeState linear = block.state;
  deformBy(block.lattice, gradient, linear);
  LoadingPatch border;
  for (const int node : nodesOf(block.lattice)) {
    const auto index = block.lattice.gridIndex(node);
    const bool inside =
        std::all_of(index.begin(), index.end(), [](int i) { return i > 0 && i < 4; });
    if (inside) continue;
    border.nodes.push_back(node);
    border.displacement.push_back(linear.displacement[at(node)]);
  }
  ASSERT_LT(border.nodes.size(), linear.displacement.size());
  ASSERT_EQ(block.solve({border}).status, SolveStatus::kOk);
  for (const int node : nodesOf(block.lattice)) {
    EXPECT_LT((block.state.displacement[at(node)] - linear.displacement[at(node)]).norm(),
              1e-6 * kSpacing);
  }
}

TissueConfig pressedBlock(double poisson_ratio) {
  return withFixedBottom(elasticBlockOf(6, 6, 4, poisson_ratio));
}

std::vector<int> punchNodes(const Lattice& lattice, const TissueConfig& config) {
  return lattice.nodesIn(nodeBox(config, {2, 2, 4}, {4, 4, 4}));
}

TEST(Newton, BalancesEveryFreeNode) {
  const TissueConfig config = pressedBlock(0.45);
  ElasticBlock block(config);
  const std::vector<int> punch = punchNodes(block.lattice, config);
  const SolveReport report = block.solve({displaced(punch, Vec3(0.0, 0.0, -0.005))});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(report.residual, 1e-10);
  EXPECT_LT(report.error_estimate, 1e-9);
  EXPECT_GT(report.iterations, 0);
  const double force = report.patches[0].force.norm();
  ASSERT_GT(force, 0.1);
  for (const int node : nodesOf(block.lattice)) {
    if (block.lattice.isFixed(node)) continue;
    if (std::binary_search(punch.begin(), punch.end(), node)) continue;
    EXPECT_LT(block.model.nodeForce(block.state, node).norm(), 1e-9 * force);
  }
}

TEST(Newton, ShapeDoesNotDependOnTheNumberOfIncrements) {
  const TissueConfig config = pressedBlock(0.45);
  ElasticBlock at_once(config), slowly(config);
  const std::vector<int> punch = punchNodes(at_once.lattice, config);
  const Vec3 deep(0.002, 0.0, -0.015);
  ASSERT_EQ(at_once.solve({displaced(punch, deep)}).status, SolveStatus::kOk);
  for (int increment = 1; increment <= 6; ++increment) {
    ASSERT_EQ(slowly.solve({displaced(punch, deep * (increment / 6.0))}).status, SolveStatus::kOk);
  }
  for (const int node : nodesOf(at_once.lattice)) {
    EXPECT_LT((at_once.state.displacement[at(node)] - slowly.state.displacement[at(node)]).norm(),
              1e-9);
  }
}

TEST(Newton, PatchByForceMovesAsOneAndAnswersItsForce) {
  const TissueConfig config = pressedBlock(0.3);
  ElasticBlock block(config);
  const std::vector<int> punch = punchNodes(block.lattice, config);
  const Vec3 force(0.3, -0.1, -0.8);
  const SolveReport report = block.solve({forced(punch, force)});
  ASSERT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT((report.patches[0].force - force).norm(), 1e-9 * force.norm());
  const Vec3 moved = report.patches[0].displacement;
  ASSERT_GT(moved.norm(), 1e-4);
  for (const int node : punch) EXPECT_EQ(block.state.displacement[at(node)], moved);
  // Moved there instead of pushed, it meets the same force.
  ElasticBlock other(config);
  const SolveReport answer = other.solve({displaced(punch, moved)});
  EXPECT_LT((answer.patches[0].force - force).norm(), 1e-7 * force.norm());
}

TEST(Newton, SolvesSeveralPatchesUnderGravity) {
  TissueConfig config = pressedBlock(0.45);
  config.gravity = Vec3(0.0, 0.0, -9.81);
  ElasticBlock block(config);
  LoadingPatch push =
      forced(block.lattice.nodesIn(nodeBox(config, {0, 2, 4}, {1, 4, 4})), Vec3(0.2, 0.0, -0.2));
  LoadingPatch pull = displaced(block.lattice.nodesIn(nodeBox(config, {5, 2, 4}, {6, 4, 4})),
                                Vec3(0.0, 0.0, 0.003));
  pull.name = "pull";
  pull.free_axis[1] = true;
  const SolveReport report = block.solve({push, pull});
  ASSERT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(report.patches[1].force.y(), 0.0);
  // What the bottom, the patches and gravity do adds up to zero.
  Vec3 total = report.patches[0].force + report.patches[1].force;
  double mass = 0.0;
  const std::vector<Vec3> forces = block.model.nodeForces(block.state);
  for (const int node : nodesOf(block.lattice)) {
    mass += block.lattice.mass(node);
    if (block.lattice.isFixed(node)) total -= forces[at(node)];
  }
  total += mass * config.gravity;
  EXPECT_LT(total.norm(), 1e-9);
  ASSERT_GT(mass * 9.81, 1.0);
}

TEST(Newton, BarBendsUnderItsWeightByMoreThanHalfItsLength) {
  TissueConfig config = elasticBlockOf(16, 2, 2, 0.45);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 2, 2}));
  config.gravity = Vec3(0.0, 0.0, -4.0);
  ElasticBlock block(config);
  const SolveReport report = block.solve({});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(block.state.displacement.back().z(), -0.5 * 0.16);
  EXPECT_EQ(countInvertedCells(block.lattice, block.state), 0);
}

TEST(Newton, KeepsTheVolumeOfNearlyIncompressibleTissue) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(8, 8, 5, 0.49));
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(config, solver);
  const auto reports =
      reportsOf(tissue, loadOf({displacedPatch("punch", nodeBox(config, {3, 3, 5}, {5, 5, 5}),
                                               Vec3(0.0, 0.0, -0.01))}));
  EXPECT_EQ(reports.back().status, SolveStatus::kOk);
  EXPECT_GT(reports.back().volume_ratio, 0.98);
  EXPECT_LT(reports.back().volume_ratio, 1.0);
}

TEST(Newton, SaysSoWhenItDidNotConverge) {
  const TissueConfig config = pressedBlock(0.45);
  NewtonOptions options;
  options.max_iterations = 1;
  ElasticBlock block(config, options);
  const SolveReport report =
      block.solve({displaced(punchNodes(block.lattice, config), Vec3(0.0, 0.0, -0.01))});
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  EXPECT_GT(report.residual, 1e-10);
}

TEST(Newton, TakesNoMoreIterationsThanItMay) {
  const TissueConfig config = pressedBlock(0.45);
  ElasticBlock block(config);
  block.method.limitIterations(2);
  const SolveReport report =
      block.solve({displaced(punchNodes(block.lattice, config), Vec3(0.0, 0.0, -0.01))});
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  EXPECT_EQ(report.iterations, 2);
}

TEST(Newton, SaysSoWhenItsTimeIsUp) {
  const TissueConfig config = pressedBlock(0.45);
  NewtonOptions options;
  options.max_ms = 1e-6;
  ElasticBlock block(config, options);
  const SolveReport report =
      block.solve({displaced(punchNodes(block.lattice, config), Vec3(0.0, 0.0, -0.01))});
  EXPECT_EQ(report.status, SolveStatus::kLate);
}

TEST(Newton, FloatingTissueUnderAForceHasNoEquilibrium) {
  const TissueConfig config = elasticBlockOf(3, 3, 3, 0.45);
  ElasticBlock block(config);
  const SolveReport report = block.solve(
      {forced(block.lattice.nodesIn(nodeBox(config, {1, 1, 3}, {2, 2, 3})), Vec3(0.0, 0.0, -0.1))});
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  for (const Vec3& moved : block.state.displacement) EXPECT_TRUE(moved.allFinite());
}

TEST(Newton, RestStaysAtRest) {
  ElasticBlock block(pressedBlock(0.49));
  const SolveReport report = block.solve({});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(report.iterations, 0);
  for (const Vec3& moved : block.state.displacement) EXPECT_EQ(moved, Vec3(Vec3::Zero()));
}

TEST(Newton, LeavesAPieceCutOffWhereItIs) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(3, 3, 5, 0.45));
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(config, solver);
  const double height = 2.5 * kSpacing;
  const CutReport cut = tissue.cut(
      {Vec3(-1, -1, height), Vec3(1, -1, height), Vec3(1, 1, height), Vec3(-1, 1, height)});
  ASSERT_EQ(cut.pieces, 2);
  EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
  const auto reports =
      reportsOf(tissue, loadOf({displacedPatch("punch", nodeBox(config, {1, 1, 2}, {2, 2, 2}),
                                               Vec3(0.0, 0.0, -0.004))}));
  EXPECT_EQ(reports.back().status, SolveStatus::kOk);
  EXPECT_GT(reports.back().patches[0].force.norm(), 0.01);
  for (const int node : tissue.lattice().nodesIn(nodeBox(config, {0, 0, 3}, {3, 3, 5}))) {
    EXPECT_LT(tissue.state().displacement[at(node)].norm(), 1e-9 * kSpacing);
  }
}

TEST(Newton, IsRefusedForTheSixSpringLattice) {
  TissueConfig config = pressedBlock(0.45);
  config.model = "six_spring";
  SolverConfig solver;
  solver.method = "newton";
  const std::string line = inputErrorOf([&] { const Tissue tissue(config, solver); });
  EXPECT_TRUE(isOneLine(line) && mentions(line, "solver.method") && mentions(line, "newton") &&
              mentions(line, "allowed: paper"))
      << line;
}

TEST(PaperMethod, IsRefusedForElasticTissue) {
  const std::string line =
      inputErrorOf([] { const Tissue tissue(pressedBlock(0.45), paperSolver()); });
  EXPECT_TRUE(isOneLine(line) && mentions(line, "solver.method") && mentions(line, "paper") &&
              mentions(line, "allowed: newton"))
      << line;
}

}  // namespace
}  // namespace robot_tissue::test_newton_method
