// Loading patches under the paper's method: force driven, hard as one piece, free axes, disturbed
// nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "block_fixtures.h"

namespace robot_tissue::test_paper_method_loads {
namespace {

TissueConfig floatingBlock() { return blockOf(10, 10, 5); }

std::vector<int> middleOfTop(const Lattice& lattice, const TissueConfig& config) {
  return lattice.nodesIn(nodeBox(config, {4, 4, 5}, {6, 6, 5}));
}

// The force, in the given number of load steps; every step must answer its load.
void expectAnswer(const TissueConfig& config, const Vec3& force, int steps) {
  PaperBlock block(config);
  const std::vector<int> patch = middleOfTop(block.lattice, config);
  ASSERT_EQ(patch.size(), 9u);
  for (int step = 1; step <= steps; ++step) {
    const Vec3 load = force * step / steps;
    const SolveReport report = block.solve({forced(patch, load)});
    EXPECT_EQ(report.status, SolveStatus::kOk);
    ASSERT_EQ(report.patches.size(), 1u);
    EXPECT_LT((report.patches[0].force - load).norm(), 1e-5 * load.norm()) << "step " << step;
    // The same seen from the springs: what they leave unbalanced on the patch.
    Vec3 answer = Vec3::Zero();
    for (const int node : patch) answer -= block.model.nodeForce(block.state, node);
    EXPECT_LT((answer - load).norm(), 1e-5 * load.norm());
    EXPECT_GT(report.patches[0].displacement.dot(load), 0.0);
    for (const int node : patch) {
      const Vec3& moved = block.state.displacement[at(node)];
      EXPECT_EQ(moved, block.state.displacement[at(patch[0])]) << "not one hard piece";
      EXPECT_LT((moved - report.patches[0].displacement).norm(), 1e-12);
    }
  }
}

TEST(ForcedPatch, StraightDownOnAFixedBlock) {
  expectAnswer(withFixedBottom(floatingBlock()), Vec3(0.0, 0.0, -0.5), 5);
}
TEST(ForcedPatch, DiagonalOnAFixedBlock) {
  expectAnswer(withFixedBottom(floatingBlock()), Vec3(0.2, 0.1, -0.3), 5);
}
TEST(ForcedPatch, UpwardsOnAFixedBlock) {
  expectAnswer(withFixedBottom(floatingBlock()), Vec3(0.0, 0.0, 0.5), 5);
}
TEST(ForcedPatch, StraightDownOnAFloatingBlock) {
  expectAnswer(floatingBlock(), Vec3(0.0, 0.0, -0.5), 5);
}
TEST(ForcedPatch, DiagonalUpwardOnAFloatingBlock) {  // the paper's figure 6
  expectAnswer(floatingBlock(), Vec3(0.1, 0.2, 0.3), 5);
}

TEST(ForcedPatch, HarderPushGoesDeeper) {
  double deepest = 0.0;
  for (const double push : {0.1, 0.2, 0.4}) {
    const TissueConfig config = withFixedBottom(floatingBlock());
    PaperBlock block(config);
    const SolveReport report =
        block.solve({forced(middleOfTop(block.lattice, config), Vec3(0.0, 0.0, -push))});
    EXPECT_LT(report.patches.at(0).displacement.z(), deepest);
    deepest = report.patches.at(0).displacement.z();
  }
}

// Springs join the two: what one is moved, the other feels.
TEST(ForcedPatch, NeighborsBothAnswerTheirLoadsOrSayThatTheyDoNot) {
  const TissueConfig config = withFixedBottom(floatingBlock());
  PaperBlock block(config);
  const Vec3 push(0.05, 0.0, -0.2), pull(0.05, 0.0, 0.1);
  const SolveReport report =
      block.solve({forced(block.lattice.nodesIn(nodeBox(config, {2, 4, 5}, {4, 6, 5})), push),
                   forced(block.lattice.nodesIn(nodeBox(config, {5, 4, 5}, {7, 6, 5})), pull)},
                  {});
  ASSERT_EQ(report.patches.size(), 2u);
  const bool both = (report.patches[0].force - push).norm() < 1e-5 * push.norm() &&
                    (report.patches[1].force - pull).norm() < 1e-5 * pull.norm();
  EXPECT_EQ(report.status == SolveStatus::kOk, both);
}

TEST(ForcedPatch, ReportsALoadItCannotBalance) {
  // Nothing holds a patch that is the whole floating block.
  const TissueConfig config = blockOf(2, 2, 2);
  PaperBlock block(config);
  const SolveReport report = block.solve({forced(nodesOf(block.lattice), Vec3(0.0, 0.0, -0.1))});
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  for (const Vec3& moved : block.state.displacement) EXPECT_TRUE(moved.allFinite());
}

TEST(DisplacedPatch, MovesAsOneToItsPlace) {
  const TissueConfig config = withFixedBottom(floatingBlock());
  PaperBlock block(config);
  const std::vector<int> patch = middleOfTop(block.lattice, config);
  const Vec3 way(5e-4, -3e-4, -1e-3);
  const SolveReport report = block.solve({displaced(patch, way)});
  for (const int node : patch) EXPECT_LT((block.state.displacement[at(node)] - way).norm(), 1e-15);
  EXPECT_LT((report.patches.at(0).displacement - way).norm(), 1e-15);
  EXPECT_GT(report.patches[0].force.dot(way), 0.0);
}

TEST(DisplacedPatch, NodesMayHaveWaysOfTheirOwn) {  // a tool that turns
  const TissueConfig config = withFixedBottom(floatingBlock());
  PaperBlock block(config);
  LoadingPatch punch = displaced(middleOfTop(block.lattice, config), Vec3::Zero());
  for (std::size_t i = 0; i < punch.nodes.size(); ++i) {
    punch.displacement[i] = Vec3(1e-5, -2e-5, -1e-4) * static_cast<double>(i);
  }
  block.solve({punch});
  for (std::size_t i = 0; i < punch.nodes.size(); ++i) {
    EXPECT_LT((block.state.displacement[at(punch.nodes[i])] - punch.displacement[i]).norm(), 1e-15);
  }
}

TEST(DisplacedPatch, HeldPatchBlocksWhatAnotherPushes) {
  const TissueConfig config = withFixedBottom(blockOf(8, 2, 2));
  PaperBlock block(config);
  LoadingPatch pushed =
      displaced(block.lattice.nodesIn(nodeBox(config, {2, 0, 1}, {2, 2, 2})), Vec3(2e-3, 0.0, 0.0));
  LoadingPatch held =
      displaced(block.lattice.nodesIn(nodeBox(config, {4, 0, 1}, {4, 2, 2})), Vec3::Zero());
  held.name = "held";
  const SolveReport report = block.solve({pushed, held});
  ASSERT_EQ(report.patches.size(), 2u);
  EXPECT_GT(report.patches[0].force.x(), 0.0);
  EXPECT_LT(report.patches[1].force.x(), 0.0);
  for (const int node : held.nodes) EXPECT_TRUE(block.state.displacement[at(node)].isZero(0.0));
  for (int k = 1; k <= 2; ++k) {
    EXPECT_TRUE(block.state.displacement[at(block.lattice.node(5, 1, k))].isZero(0.0));
  }
}

// A frictionless plate on top of one layer of cells; the row's end is held and pulled sideways, so
// that the nodes under the plate slide after it.
TEST(FreeAxis, NodesSlideUntilBalancedAlongIt) {
  const TissueConfig config = withFixedBottom(blockOf(6, 2, 1));
  const PaperOptions options;
  PaperBlock block(config, options);
  LoadingPatch plate = displaced(block.lattice.nodesIn(nodeBox(config, {1, 0, 1}, {6, 2, 1})),
                                 Vec3(0.0, 0.0, -1e-3));
  plate.free_axis = {{true, false, false}};
  const Vec3 pull(-2e-3, 0.0, -1e-3);
  LoadingPatch end = displaced(block.lattice.nodesIn(nodeBox(config, {0, 0, 1}, {0, 2, 1})), pull);
  end.name = "end";
  LatticeState loaded = block.state;
  for (const int node : plate.nodes) loaded.displacement[at(node)].z() = -1e-3;
  for (const int node : end.nodes) loaded.displacement[at(node)] = pull;
  double greatest = 0.0;  // N, on a patch node before the nodes slide
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    if (block.lattice.isFixed(node)) continue;
    greatest = std::max(greatest, block.model.nodeForce(loaded, node).norm());
  }
  const SolveReport report = block.solve({plate, end});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  for (const int node : plate.nodes) {
    const Vec3& moved = block.state.displacement[at(node)];
    EXPECT_EQ(moved.y(), 0.0);
    EXPECT_EQ(moved.z(), -1e-3);
    EXPECT_LE(std::abs(block.model.nodeForce(block.state, node).x()),
              options.balance_tolerance * greatest);
  }
  for (int j = 0; j <= 2; ++j) {
    EXPECT_LT(block.state.displacement[at(block.lattice.node(1, j, 1))].x(), -1e-4) << "no slide";
  }
  EXPECT_EQ(report.patches.at(0).force.x(), 0.0);  // a frictionless plate gives no force along it
  EXPECT_LT(report.patches[0].force.z(), 0.0);
  EXPECT_EQ(report.active_nodes, 7 * 3);  // none counted twice
}

// The plate's nodes need not be out of balance themselves for the layers below to be.
TEST(FreeAxis, LoadReachesTheLayersBelowThePlate) {
  const TissueConfig config = withFixedBottom(blockOf(2, 2, 4));
  PaperBlock block(config);
  LoadingPatch plate = displaced(block.lattice.nodesIn(nodeBox(config, {0, 0, 4}, {2, 2, 4})),
                                 Vec3(0.0, 0.0, -1e-3));
  plate.free_axis = {{true, true, false}};
  const SolveReport report = block.solve({plate});
  EXPECT_GE(report.layers, 2);
  for (const int node : block.lattice.nodesIn(nodeBox(config, {0, 0, 3}, {2, 2, 3}))) {
    EXPECT_LT(block.state.displacement[at(node)].z(), -1e-4);
  }
}

TEST(Disturbed, NodesAreBalancedWithoutAPatch) {
  const TissueConfig config = withFixedBottom(blockOf(6, 6, 3));
  PaperBlock block(config);
  const int node = block.lattice.node(3, 3, 2);
  block.state.displacement[at(node)] = Vec3(0.0, 0.0, 2e-3);
  const double before = block.model.nodeForce(block.state, node).norm();
  const SolveReport report = block.solve({}, {node});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_GE(report.layers, 1);
  EXPECT_LT(block.state.displacement[at(node)].norm(), 1e-3);
  EXPECT_LT(block.model.nodeForce(block.state, node).norm(), 0.5 * before);
}

}  // namespace
}  // namespace robot_tissue::test_paper_method_loads
