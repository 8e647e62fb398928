// Method `layered` against method `newton`: shapes, and what it says of its own error.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "cutting/cut.h"
#include "layered_fixtures.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_layered_method {
namespace {

class LayeredPress : public testing::TestWithParam<std::tuple<double, double>> {};

// Down by 16 mm of 40, aside by 6, back up to 4.
TEST_P(LayeredPress, AgreesWithNewtonWithinTheErrorItStates) {
  const auto [poisson_ratio, tolerance] = GetParam();
  const TissueConfig config = pressBlock(poisson_ratio);
  LayeredBlock block(config, within(tolerance));
  ElasticBlock exact(config);
  const std::vector<Vec3> path = {
      {0, 0, -0.0002},    {0, 0, -0.004},     {0, 0, -0.008},     {0, 0, -0.012}, {0, 0, -0.016},
      {0.003, 0, -0.016}, {0.006, 0, -0.016}, {0.003, 0, -0.012}, {0, 0, -0.008}, {0, 0, -0.004}};
  for (const Vec3& place : path) {
    const LoadingPatch punch = punchOn(block.lattice, block.model, block.state, config, place);
    ASSERT_FALSE(punch.rim.empty());
    const SolveReport report = block.solve({punch});
    const SolveReport right = exact.solve({punch});
    ASSERT_EQ(right.status, SolveStatus::kOk);
    expectHonest(block, report, exact, tolerance, 25.0);
    EXPECT_NEAR(report.patches[0].force.z(), right.patches[0].force.z(),
                3.0 * tolerance * right.patches[0].force.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(RatiosAndTolerances, LayeredPress,
                         testing::Combine(testing::Values(0.25, 0.45, 0.49),
                                          testing::Values(1e-2, 1e-3, 1e-6)));

TEST(Layered, BalancesEveryFreeNode) {
  const TissueConfig config = pressBlock(0.45);
  LayeredBlock block(config, within(1e-8));
  const LoadingPatch punch =
      punchOn(block.lattice, block.model, block.state, config, Vec3(0.001, 0, -0.005));
  const SolveReport report = block.solve({punch});
  ASSERT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(report.residual, 1e-6);
  std::vector<Vec3> forces = block.model.nodeForces(block.state);
  addRimForces(punch, block.state.displacement, forces);
  const std::vector<int> hard = hardNodes(punch);
  for (const int node : nodesOf(block.lattice)) {
    if (block.lattice.isFixed(node) || std::binary_search(hard.begin(), hard.end(), node)) continue;
    EXPECT_LT(forces[at(node)].norm(), 1e-6 * report.patches[0].force.norm());
  }
}

TEST(Layered, SymmetricPressHasASymmetricShape) {
  const TissueConfig config = pressBlock(0.45);
  LayeredBlock block(config, within(1e-7));
  ASSERT_EQ(
      block.solve({punchOn(block.lattice, block.model, block.state, config, Vec3(0, 0, -0.005))})
          .status,
      SolveStatus::kOk);
  for (const int node : nodesOf(block.lattice)) {
    const auto index = block.lattice.gridIndex(node);
    const int mirrored = block.lattice.node(8 - index[0], index[1], index[2]);
    const int swapped = block.lattice.node(index[1], index[0], index[2]);
    const Vec3& here = block.state.displacement[at(node)];
    const Vec3& there = block.state.displacement[at(mirrored)];
    EXPECT_LT((here - Vec3(-there.x(), there.y(), there.z())).norm(), 1e-8);
    const Vec3& across = block.state.displacement[at(swapped)];
    EXPECT_LT((here - Vec3(across.y(), across.x(), across.z())).norm(), 1e-8);
  }
}

TEST(Layered, TwoRunsAreEqualBitForBit) {
  const TissueConfig config = pressBlock(0.45);
  LayeredBlock first(config), second(config);
  for (const double depth : {0.003, 0.006, 0.002}) {
    for (LayeredBlock* block : {&first, &second}) {
      block->solve(
          {punchOn(block->lattice, block->model, block->state, config, Vec3(0.0005, 0, -depth))});
    }
    ASSERT_EQ(first.state.displacement, second.state.displacement);
  }
}

// Where a part is open, and where all is.
TEST(Layered, AnyNumberOfThreadsGivesTheSameBits) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(32, 32, 16, 0.45));
  for (const double tolerance : {0.01, 0.004}) {
    std::vector<Vec3> first;
    for (const int threads : {1, 2, 3, 7}) {
      LayeredOptions options;
      options.threads = threads;
      options.tolerance = tolerance;
      LayeredBlock block(config, options);
      LoadingPatch punch =
          displaced(block.lattice.nodesIn(nodeBox(config, {12, 12, 16}, {17, 17, 16})),
                    Vec3(0.001, 0, -0.006));
      block.solve({punch});
      if (first.empty()) first = block.state.displacement;
      ASSERT_EQ(block.state.displacement, first) << threads << ' ' << tolerance;
    }
  }
}

TEST(Layered, SolveInBalanceIsOneCheck) {
  const TissueConfig config = pressBlock(0.45);
  LayeredBlock block(config);
  const LoadingPatch punch =
      punchOn(block.lattice, block.model, block.state, config, Vec3(0, 0, -0.004));
  ASSERT_GT(block.solve({punch}).iterations, 0);
  const std::vector<Vec3> before = block.state.displacement;
  const SolveReport again = block.solve({punch});
  EXPECT_EQ(again.status, SolveStatus::kOk);
  EXPECT_EQ(again.iterations, 0);
  EXPECT_EQ(block.state.displacement, before);
}

TEST(Layered, RestStaysAtRestAndNothingIsVisited) {
  LayeredBlock block(pressBlock(0.49));
  const SolveReport report = block.solve({});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(report.active_nodes, 0);
  EXPECT_EQ(report.layers, 0);
  for (const Vec3& moved : block.state.displacement) EXPECT_EQ(moved, Vec3(Vec3::Zero()));
}

TEST(Layered, TissueFarFromTheLoadIsNotVisited) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(48, 16, 16, 0.3));
  LayeredBlock block(config);
  const std::vector<int> end = block.lattice.nodesIn(nodeBox(config, {0, 7, 16}, {1, 8, 16}));
  const SolveReport report = block.solve({displaced(end, Vec3(0, 0, -0.003))});
  ASSERT_EQ(report.status, SolveStatus::kOk);
  EXPECT_GT(report.layers, 3);
  EXPECT_LT(report.layers, 40);
  EXPECT_LT(report.active_nodes, block.lattice.nodeCount() / 2);
  for (const int node : block.lattice.nodesIn(nodeBox(config, {36, 0, 0}, {48, 16, 16}))) {
    EXPECT_LT(block.state.displacement[at(node)].norm(), 1e-3 * 0.003);
  }
  LayeredBlock exact(config, within(1e-6));
  exact.solve({displaced(end, Vec3(0, 0, -0.003))});
  EXPECT_LE(
      errorOf(block.lattice, block.patches, block.state.displacement, exact.state.displacement),
      3.0 * report.error_estimate);
}

TEST(Layered, ReleasedAtOnceGoesBackToRest) {
  const TissueConfig config = pressBlock(0.45);
  LayeredBlock block(config);
  for (const double depth : {0.004, 0.008, 0.012}) {
    block.solve({punchOn(block.lattice, block.model, block.state, config, Vec3(0, 0, -depth))});
  }
  ASSERT_GT(block.state.displacement[at(block.lattice.node(4, 4, 4))].norm(), 0.01);
  const SolveReport report = block.solve({});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  for (const Vec3& moved : block.state.displacement) EXPECT_LT(moved.norm(), 1e-6 * 0.01);
}

// Nodes of cells that the ball only grazes are thrown over each other on the way down. Nothing that
// is without material may keep them so.
TEST(Layered, NarrowPressedByAThirdComesBack) {
  TissueConfig config;
  config.mesh = std::make_shared<const TriangleMesh>(sphereMesh(0.03, 4));
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.45;
  config.fixed = {{Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, -0.015)}};
  LayeredBlock block(config);
  LoadingPatch punch;
  punch.nodes = block.lattice.nodesIn({Vec3(-0.012, -0.012, 0.024), Vec3(0.012, 0.012, 1.0)});
  punch.displacement.assign(punch.nodes.size(), Vec3(0.0, 0.0, -0.02));
  const SolveReport pressed = block.solve({punch});
  EXPECT_EQ(pressed.status, SolveStatus::kOk);
  ASSERT_GT(pressed.patches.at(0).force.norm(), 5.0);
  EXPECT_EQ(block.solve({}).status, SolveStatus::kOk);
  for (const Vec3& moved : block.state.displacement) EXPECT_LT(moved.norm(), 1e-6 * 0.005);
}

// A bar of 20 cells at the lower edge of a block that hangs from its top, cut off but for part
// of a cell at one end: forces that bring it home are small beside those that are gone at once, and
// conjugate gradients over the last cycle alone took more than a thousand cycles.
TEST(Layered, BarThatHangsByASliverComesBack) {
  TissueConfig config = elasticBlockOf(20, 4, 4, 0.45);
  config.fixed = {nodeBox(config, {0, 0, 4}, {20, 4, 4})};
  LayeredBlock block(config);
  const double h = config.spacing, low = -1.0 * h, half = 0.25 * h, beside = 1.25 * h;
  const double end = 21.0 * h;
  const auto cut = [&](const std::vector<Vec3>& corners) {
    sever(block.lattice, springsAcross(block.lattice, block.state, corners), block.state,
          block.model.splitCells());
  };
  cut({{low, beside, low}, {end, beside, low}, {end, beside, beside}, {low, beside, beside}});
  cut({{half, low, beside}, {end, low, beside}, {end, beside, beside}, {half, beside, beside}});
  cut({{low, low, beside}, {half, low, beside}, {half, half, beside}, {low, half, beside}});
  const std::vector<int> held = block.lattice.nodesIn(nodeBox(config, {20, 0, 0}, {20, 1, 1}));
  EXPECT_EQ(block.solve({displaced(held, Vec3(0.0, 0.0, -4.0 * h))}).status, SolveStatus::kOk);
  block.method.forget();
  std::vector<int> all(block.state.displacement.size());
  std::iota(all.begin(), all.end(), 0);
  const SolveReport report = block.solve({}, all);
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(report.iterations, 1000);
  for (const Vec3& moved : block.state.displacement) EXPECT_LT(moved.norm(), 1e-5 * h);
}

TEST(Layered, LateSolveIsCarriedOn) {
  const TissueConfig config = pressBlock(0.49);
  LayeredOptions options = within(1e-6);
  options.max_ms = 1e-6;
  LayeredBlock block(config, options);
  const LoadingPatch punch =
      punchOn(block.lattice, block.model, block.state, config, Vec3(0, 0, -0.004));
  SolveReport report = block.solve({punch});
  ASSERT_EQ(report.status, SolveStatus::kLate);
  EXPECT_GT(report.error_estimate, options.tolerance);
  for (const Vec3& moved : block.state.displacement) ASSERT_TRUE(moved.allFinite());
  int solves = 1;
  while (report.status == SolveStatus::kLate && solves < 200) {
    report = block.solve({punch});
    ++solves;
  }
  ElasticBlock exact(config);
  exact.solve({punch});
  expectHonest(block, report, exact, 1e-6);
}

TEST(Layered, SaysSoWhenItDidNotConverge) {
  const TissueConfig config = pressBlock(0.45);
  LayeredOptions options = within(1e-6);
  options.max_cycles = 2;
  LayeredBlock block(config, options);
  const SolveReport report =
      block.solve({punchOn(block.lattice, block.model, block.state, config, Vec3(0, 0, -0.004))});
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  EXPECT_GT(report.error_estimate, 1e-6);
}

// Corners thrown about by up to more than a spacing: cells pressed flat and turned inside out.
TEST(Layered, CrushedCellsRecover) {
  const TissueConfig config = pressBlock(0.3);
  LayeredBlock block(config);
  const std::vector<int> crushed = block.lattice.nodesIn(nodeBox(config, {2, 2, 2}, {6, 6, 4}));
  for (const int node : crushed) {
    Shaker shaker(static_cast<unsigned>(node));
    block.state.displacement[at(node)] = shaker.displacement(0.012);
  }
  ASSERT_GT(countInvertedCells(block.lattice, block.state), 0);
  const SolveReport report = block.solve({}, crushed);
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(countInvertedCells(block.lattice, block.state), 0);
  for (const Vec3& moved : block.state.displacement) EXPECT_LT(moved.norm(), 1e-6 * 0.01);
}

}  // namespace
}  // namespace robot_tissue::test_layered_method
