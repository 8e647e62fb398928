// Method `layered` where it visits a part of the lattice: what it makes of the rest.
#include <gtest/gtest.h>

#include <numeric>

#include "layered_fixtures.h"
#include "solvers/multigrid/hierarchy/level_source.h"

namespace robot_tissue::test_layered_parts {
namespace {

constexpr double kTolerance = 0.01;

// So wide that a load of some cells leaves most of it alone.
TissueConfig wideBlock(double poisson_ratio) {
  return withFixedBottom(elasticBlockOf(32, 32, 16, poisson_ratio));
}

LoadingPatch pressed(const Lattice& lattice, const TissueConfig& config, int at_x,
                     const Vec3& displacement) {
  return displaced(lattice.nodesIn(nodeBox(config, {at_x, 14, 16}, {at_x + 4, 18, 16})),
                   displacement);
}

// The same lattice, all of it visited, to where rounding begins.
struct Exact {
  explicit Exact(const TissueConfig& config) : block(config, within(1e-6)) {}
  void solve(const LoadingPatch& patch) {
    ASSERT_EQ(block.solve({patch}).status, SolveStatus::kOk);
  }
  LayeredBlock block;
};

void expectNear(const LayeredBlock& block, const SolveReport& report, const Exact& exact) {
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LE(report.error_estimate, kTolerance);
  const double error = errorOf(block.lattice, block.patches, block.state.displacement,
                               exact.block.state.displacement);
  EXPECT_LE(error, 1.2 * kTolerance);
  EXPECT_LE(error, 3.0 * report.error_estimate);
}

class LayeredParts : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Ratios, LayeredParts, testing::Values(0.25, 0.45));

TEST_P(LayeredParts, AreAsNearTheEquilibriumAsTheWhole) {
  const TissueConfig config = wideBlock(GetParam());
  LayeredBlock block(config, within(kTolerance));
  Exact exact(config);
  for (const Vec3& place : {Vec3(0, 0, -0.005), Vec3(0, 0, -0.01), Vec3(0, 0, -0.015),
                            Vec3(0.005, 0, -0.015), Vec3(0, 0, -0.005)}) {
    const LoadingPatch punch = pressed(block.lattice, config, 14, place);
    const SolveReport report = block.solve({punch});
    exact.solve(punch);
    expectNear(block, report, exact);
    EXPECT_LT(report.active_nodes, block.lattice.nodeCount() / 3);
  }
}

// With coarse cells that are filled by half, at all ends of the block.
TEST_P(LayeredParts, GetOnWithAnOddNumberOfCells) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(35, 33, 17, GetParam()));
  LayeredBlock block(config, within(kTolerance));
  Exact exact(config);
  for (const double depth : {0.005, 0.01, 0.015}) {
    const LoadingPatch punch = displaced(
        block.lattice.nodesIn(nodeBox(config, {15, 14, 17}, {19, 18, 17})), Vec3(0, 0, -depth));
    const SolveReport report = block.solve({punch});
    exact.solve(punch);
    expectNear(block, report, exact);
    EXPECT_LT(report.active_nodes, block.lattice.nodeCount() / 3);
  }
}

// What the patch does to the tissue, the fixed nodes far off have to bear. They tell it where the
// tissue may be squeezed: else means of coarse nodes put more on them than there is.
TEST(LayeredParts, LoseNoForceWhereTheyMeet) {
  const TissueConfig config = wideBlock(0.25);
  LayeredBlock block(config, within(kTolerance));
  const SolveReport report =
      block.solve({pressed(block.lattice, config, 14, Vec3(0.002, 0, -0.01))});
  ASSERT_LT(report.active_nodes, block.lattice.nodeCount() / 3);
  Vec3 borne = Vec3::Zero();
  for (const int node : nodesOf(block.lattice)) {
    if (block.lattice.isFixed(node)) borne += block.model.nodeForce(block.state, node);
  }
  const Vec3 given = report.patches.front().force;
  EXPECT_GT(given.norm(), 1.0);
  EXPECT_LT((given - borne).norm(), 3.0 * kTolerance * given.norm());
}

TEST_P(LayeredParts, HaveTheForceOfTheWhole) {
  const TissueConfig config = wideBlock(GetParam());
  LayeredBlock block(config, within(kTolerance));
  Exact exact(config);
  const LoadingPatch punch = pressed(block.lattice, config, 14, Vec3(0.002, 0, -0.01));
  const Vec3 force = block.solve({punch}).patches.front().force;
  const Vec3 right = exact.block.solve({punch}).patches.front().force;
  EXPECT_LT((force - right).norm(), 1.5 * kTolerance * right.norm());
  const Vec3 left = block.method.forceLeft();
  EXPECT_GT(left.norm(), 0.0);
  EXPECT_LT(left.norm(), 2.0 * kTolerance * force.norm());
}

// From place to place, by other parts each time: the shape is that of the last load alone.
TEST_P(LayeredParts, FollowALoadThatWanders) {
  const TissueConfig config = wideBlock(GetParam());
  LayeredBlock block(config, within(kTolerance));
  for (int at_x = 4; at_x <= 24; at_x += 4) {
    const LoadingPatch punch = pressed(block.lattice, config, at_x, Vec3(0, 0, -0.01));
    const SolveReport report = block.solve({punch});
    Exact exact(config);
    exact.solve(punch);
    expectNear(block, report, exact);
  }
}

TEST(LayeredParts, ForgottenLeaveNoTrace) {
  const TissueConfig config = wideBlock(0.45);
  LayeredBlock used(config, within(kTolerance)), fresh(config, within(kTolerance));
  used.solve({pressed(used.lattice, config, 4, Vec3(0, 0, -0.01))});
  used.method.forget();
  used.state = used.lattice.restState();
  for (LayeredBlock* block : {&used, &fresh}) {
    block->solve({pressed(block->lattice, config, 20, Vec3(0, 0, -0.01))});
  }
  EXPECT_EQ(used.state.displacement, fresh.state.displacement);
}

// A stiff piece, and fixed nodes that end between coarse ones, as coarse lattices do not know them.
TEST(LayeredParts, TakeInWhatCoarseLatticesDoNotTell) {
  TissueConfig config = elasticBlockOf(32, 32, 16, 0.3);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {19, 32, 0}));
  Region stiff{"stiff", {Vec3(0.19, 0.13, 0.09), Vec3(0.22, 0.18, 0.12)}, nullptr, config.material};
  stiff.material.young_modulus *= 100.0;
  config.regions.push_back(stiff);
  LayeredBlock block(config, within(kTolerance));
  Exact exact(config);
  const LoadingPatch punch = pressed(block.lattice, config, 6, Vec3(0, 0, -0.01));
  const SolveReport report = block.solve({punch});
  exact.solve(punch);
  expectNear(block, report, exact);
}

// Sheets and beams bend: coarse cells are too stiff for that, and cycles see it late.
TEST(LayeredParts, AreNotMadeOfWhatBends) {
  for (const std::array<int, 3>& cells :
       {std::array<int, 3>{48, 48, 2}, std::array<int, 3>{40, 40, 8},
        std::array<int, 3>{80, 16, 16}}) {
    TissueConfig config = elasticBlockOf(cells[0], cells[1], cells[2], 0.45);
    config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, cells[1], cells[2]}));
    LayeredBlock block(config, within(kTolerance));
    const int x = cells[0] / 2, y = cells[1] / 2;
    const LoadingPatch punch = displaced(
        block.lattice.nodesIn(nodeBox(config, {x, y, cells[2]}, {x + 4, y + 4, cells[2]})),
        Vec3(0, 0, -0.005));
    const SolveReport report = block.solve({punch});
    EXPECT_EQ(report.status, SolveStatus::kOk);
    EXPECT_GT(report.active_nodes, block.lattice.nodeCount() / 2);
    Exact exact(config);
    exact.solve(punch);
    EXPECT_LE(errorOf(block.lattice, block.patches, block.state.displacement,
                      exact.block.state.displacement),
              3.0 * kTolerance);
  }
}

TEST(LevelSource, TellsWhereACoarserLatticeDiffers) {
  TissueConfig config = withFixedBottom(elasticBlockOf(16, 16, 8, 0.3));
  const auto sources = [](const TissueConfig& of) {
    const Lattice lattice(of);
    const ElasticModel model(lattice, of);
    return levelSources(lattice, model, wholeOf(lattice.size()), 1.0, 3);
  };
  ASSERT_FALSE(sources(config).empty());
  EXPECT_TRUE(sources(config).front().rough.isEmpty());
  EXPECT_TRUE(sources(config).front().isUniform());
  Region stiff{"stiff", {Vec3(0.05, 0.04, 0.04), Vec3(0.06, 0.06, 0.06)}, nullptr, config.material};
  stiff.material.young_modulus *= 2.0;
  config.regions.push_back(stiff);
  const std::vector<LevelSource> all = sources(config);
  EXPECT_EQ(all[0].rough, (GridBox{{4, 4, 4}, {6, 6, 6}}));
  const auto sum = [](const std::vector<double>& moduli) {
    return std::accumulate(moduli.begin(), moduli.end(), 0.0);
  };
  EXPECT_NEAR(8.0 * sum(all[1].shear), sum(all[0].shear), 1e-9 * sum(all[0].shear));
}

TEST(LevelSource, IsNoneOfWhatHasAWeight) {
  TissueConfig config = withFixedBottom(elasticBlockOf(8, 8, 8, 0.3));
  config.gravity = Vec3(0, 0, -9.81);
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  EXPECT_TRUE(levelSources(lattice, model, wholeOf(lattice.size()), 1.0, 3).empty());
}

// Cycles in a part led nowhere, and all is visited: where they went is not measured with the fields
// of the whole, whose ends are beyond theirs. So it begins as it does where all is visited at once.
TEST(LayeredParts, TeachTheWholeNothingWhereTheyFail) {
  const TissueConfig config = wideBlock(0.25);
  LayeredOptions options = within(kTolerance);
  options.max_cycles = 0;
  LayeredBlock at_once(config, options);
  const LoadingPatch torn = pressed(at_once.lattice, config, 14, Vec3(0.03, 0, 0.1));
  const SolveReport begun = at_once.solve({torn}, nodesOf(at_once.lattice));
  ASSERT_EQ(begun.status, SolveStatus::kUnconverged);
  for (const int cycles : {1, 2, 5}) {
    options.max_cycles = cycles;
    LayeredBlock block(config, options);
    const SolveReport report = block.solve({torn});
    EXPECT_EQ(report.status, SolveStatus::kUnconverged);
    EXPECT_EQ(report.active_nodes, begun.active_nodes);
    EXPECT_NEAR(report.error_estimate, begun.error_estimate, 1e-6 * begun.error_estimate)
        << cycles << " cycles in the part";
  }
}

}  // namespace
}  // namespace robot_tissue::test_layered_parts
