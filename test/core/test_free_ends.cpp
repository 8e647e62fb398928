// Method `layered` on long blocks: ends that nothing holds or loads are left out, and go along.
#include <gtest/gtest.h>

#include "layered_fixtures.h"

namespace robot_tissue::test_free_ends {
namespace {

constexpr double kTolerance = 0.01;
constexpr int kAcross = 3, kLong = 120;

struct Bar {
  std::array<int, 3> cells{kAcross, kAcross, kAcross};
  std::size_t axis = 0;

  explicit Bar(std::size_t along) : axis(along) { cells[axis] = kLong; }
  Box nodes(const TissueConfig& config, int first, int last, bool top) const {
    std::array<int, 3> low{}, high = cells;
    low[axis] = first;
    high[axis] = last;
    if (top) low[(axis + 1) % 3] = high[(axis + 1) % 3];
    return nodeBox(config, low, high);
  }
  TissueConfig heldAt(int first, int last) const {
    TissueConfig config = elasticBlockOf(cells[0], cells[1], cells[2], 0.45);
    config.fixed.push_back(nodes(config, first, last, false));
    return config;
  }
  LoadingPatch pressedAt(const Lattice& lattice, const TissueConfig& config, int place,
                         double depth) const {
    Vec3 way = Vec3::Zero();
    way[static_cast<Eigen::Index>((axis + 1) % 3)] = -depth;
    return displaced(lattice.nodesIn(nodes(config, place, place + 2, true)), way);
  }
};

void expectTheShapeOf(const ElasticBlock& exact, const LayeredBlock& block) {
  EXPECT_LE(
      errorOf(block.lattice, block.patches, block.state.displacement, exact.state.displacement),
      3.0 * kTolerance);
}

// Pressed there, one depth after the other, the ends are left out, and the shape is the exact one.
void expectEndsToGoAlong(const Bar& bar, const TissueConfig& config, int place,
                         const std::vector<double>& depths) {
  LayeredBlock block(config, within(kTolerance));
  ElasticBlock exact(config);
  for (const double depth : depths) {
    const LoadingPatch punch = bar.pressedAt(block.lattice, config, place, depth);
    const SolveReport report = block.solve({punch});
    ASSERT_EQ(exact.solve({punch}).status, SolveStatus::kOk);
    EXPECT_EQ(report.status, SolveStatus::kOk);
    EXPECT_LT(report.active_nodes, block.lattice.nodeCount() / 2);
    expectTheShapeOf(exact, block);
  }
}

class FreeEndsOf : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Axes, FreeEndsOf, testing::Values(0, 1, 2));

// Bent near where it is held: a long end turns with what is bent, out to its tip.
TEST_P(FreeEndsOf, ABarGoWithWhatIsBent) {
  const Bar bar(GetParam());
  expectEndsToGoAlong(bar, bar.heldAt(0, 2), 8, {0.001, 0.003});
}

// Held in its middle it has two, of which one bends with the load.
TEST_P(FreeEndsOf, ABarHeldInItsMiddleGoOnBothSides) {
  const Bar bar(GetParam());
  expectEndsToGoAlong(bar, bar.heldAt(60, 62), 54, {0.002});
}

// Where a load comes to an end, that is one no longer.
TEST(FreeEnds, AreNoneWhereALoadComes) {
  const Bar bar(0);
  const TissueConfig config = bar.heldAt(0, 2);
  LayeredBlock block(config, within(kTolerance));
  ElasticBlock exact(config);
  for (const int place : {8, 40, 110}) {
    const LoadingPatch punch = bar.pressedAt(block.lattice, config, place, 0.002);
    EXPECT_EQ(block.solve({punch}).status, SolveStatus::kOk);
    exact.state = exact.lattice.restState();
    ASSERT_EQ(exact.solve({punch}).status, SolveStatus::kOk);
    expectTheShapeOf(exact, block);
  }
}

TEST(FreeEnds, AreRigid) {
  const Bar bar(0);
  const TissueConfig config = bar.heldAt(0, 2);
  LayeredBlock block(config, within(kTolerance));
  block.solve({bar.pressedAt(block.lattice, config, 8, 0.01)});
  const auto apart = [&block](bool now) {
    const int low = block.lattice.node(60, 0, 0),
              high = block.lattice.node(kLong, kAcross, kAcross);
    Vec3 way = block.lattice.restPosition(high) - block.lattice.restPosition(low);
    if (now) way += block.state.displacement[at(high)] - block.state.displacement[at(low)];
    return way;
  };
  EXPECT_GT((apart(true) - apart(false)).norm(), 1e-3 * apart(false).norm());
  EXPECT_NEAR(apart(true).norm(), apart(false).norm(), 1e-12);
}

TEST(FreeEnds, AreForgottenWithoutATrace) {
  const Bar bar(0);
  const TissueConfig config = bar.heldAt(0, 2);
  LayeredBlock used(config, within(kTolerance)), fresh(config, within(kTolerance));
  used.solve({bar.pressedAt(used.lattice, config, 110, 0.01)});
  used.method.forget();
  used.state = used.lattice.restState();
  for (LayeredBlock* block : {&used, &fresh}) {
    block->solve({bar.pressedAt(block->lattice, config, 8, 0.01)});
  }
  EXPECT_EQ(used.state.displacement, fresh.state.displacement);
}

// Cycles, and what they move, hang on what bends, not on how long the bar is beyond.
TEST(FreeEnds, CostNothing) {
  std::vector<SolveReport> reports;
  for (const int length : {150, 4000}) {
    TissueConfig config = elasticBlockOf(length, kAcross, kAcross, 0.45);
    config.fixed.push_back(nodeBox(config, {0, 0, 0}, {2, kAcross, kAcross}));
    LayeredBlock block(config, within(kTolerance));
    reports.push_back(block.solve(
        {displaced(block.lattice.nodesIn(nodeBox(config, {8, 0, kAcross}, {10, kAcross, kAcross})),
                   Vec3(0, 0, -0.01))}));
    EXPECT_EQ(reports.back().status, SolveStatus::kOk);
  }
  EXPECT_EQ(reports.front().iterations, reports.back().iterations);
  EXPECT_EQ(reports.front().active_nodes, reports.back().active_nodes);
}

}  // namespace
}  // namespace robot_tissue::test_free_ends
