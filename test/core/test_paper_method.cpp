// The paper's method as such: order, termination, repeatability, the stiffness it converges to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "block_fixtures.h"

namespace robot_tissue::test_paper_method {
namespace {

constexpr double kSpacing = 0.005;

// 21 x 21 x 11 nodes, bottom fixed; the 5 x 5 nodes in the middle of its top are the patch.
const TissueConfig kPressed = withFixedBottom(blockOf(20, 20, 10, kSpacing));

std::vector<int> middleOfTop(const Lattice& lattice) {
  return lattice.nodesIn(nodeBox(kPressed, {8, 8, 10}, {12, 12, 10}));
}

LatticeState press(PaperBlock& block, int steps, double step) {
  const std::vector<int> patch = middleOfTop(block.lattice);
  for (int i = 1; i <= steps; ++i) {
    block.solve({displaced(patch, Vec3(0.0, 0.0, -i * step))});
  }
  return block.state;
}

int countMoved(const LatticeState& state) {
  return static_cast<int>(std::count_if(state.displacement.begin(), state.displacement.end(),
                                        [](const Vec3& moved) { return !moved.isZero(0.0); }));
}

using Mirror = std::function<std::array<int, 3>(const std::array<int, 3>&)>;
using Reflect = std::function<Vec3(const Vec3&)>;

// Nodes whose displacement is not, to the last bit, that of their image reflected.
int countAsymmetric(const PaperBlock& block, const Mirror& mirror, const Reflect& reflect) {
  int asymmetric = 0;
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    const auto image = mirror(block.lattice.gridIndex(node));
    const Vec3& moved = block.state.displacement[at(node)];
    const int twin = block.lattice.node(image[0], image[1], image[2]);
    if (moved != reflect(block.state.displacement[at(twin)])) ++asymmetric;
  }
  return asymmetric;
}

class SymmetricPress : public ::testing::Test {
 protected:
  SymmetricPress() : block_(kPressed) {
    press(block_, 5, 1e-3);
    int oblique = 0;  // nodes that moved along all three axes
    for (const Vec3& moved : block_.state.displacement) {
      if ((moved.array() != 0.0).all()) ++oblique;
    }
    EXPECT_GT(oblique, 100);
  }
  PaperBlock block_;
};

TEST_F(SymmetricPress, AboutTheMidPlaneAcrossXToTheLastBit) {
  EXPECT_EQ(countAsymmetric(
                block_,
                [](const auto& n) {
                  return std::array<int, 3>{20 - n[0], n[1], n[2]};
                },
                [](const Vec3& u) { return Vec3(-u.x(), u.y(), u.z()); }),
            0);
}

TEST_F(SymmetricPress, AboutTheMidPlaneAcrossYToTheLastBit) {
  EXPECT_EQ(countAsymmetric(
                block_,
                [](const auto& n) {
                  return std::array<int, 3>{n[0], 20 - n[1], n[2]};
                },
                [](const Vec3& u) { return Vec3(u.x(), -u.y(), u.z()); }),
            0);
}

TEST_F(SymmetricPress, AboutTheDiagonalToTheLastBit) {
  EXPECT_EQ(countAsymmetric(
                block_,
                [](const auto& n) {
                  return std::array<int, 3>{n[1], n[0], n[2]};
                },
                [](const Vec3& u) { return Vec3(u.y(), u.x(), u.z()); }),
            0);
}

TEST(PaperMethod, OrderByIndexIsNotSymmetric) {  // so that the tests above can fail
  PaperOptions options;
  options.order = PaperOptions::Order::kByIndex;
  PaperBlock block(kPressed, options);
  press(block, 5, 1e-3);
  EXPECT_GT(countAsymmetric(
                block,
                [](const auto& n) {
                  return std::array<int, 3>{20 - n[0], n[1], n[2]};
                },
                [](const Vec3& u) { return Vec3(-u.x(), u.y(), u.z()); }),
            0);
}

TEST(PaperMethod, RepeatsItselfToTheLastBit) {
  PaperBlock first(kPressed), second(kPressed);
  const LatticeState once = press(first, 4, 1e-3);
  const LatticeState again = press(second, 4, 1e-3);
  EXPECT_GT(countMoved(once), 500);
  EXPECT_EQ(once.displacement, again.displacement);

  first.state = first.lattice.restState();  // the method itself remembers nothing
  EXPECT_EQ(press(first, 4, 1e-3).displacement, again.displacement);
}

TEST(PaperMethod, AnswersSmallLoadsInProportion) {
  PaperBlock single(kPressed), twice(kPressed);
  const std::vector<int> patch = middleOfTop(single.lattice);
  const Vec3 way(0.0, 0.0, -1e-6 * kSpacing);
  const SolveReport one = single.solve({displaced(patch, way)});
  const SolveReport two = twice.solve({displaced(patch, 2.0 * way)});
  const Vec3 force = one.patches[0].force;
  ASSERT_LT(force.z(), 0.0);  // the patch pushes the tissue down
  EXPECT_LT((two.patches[0].force - 2.0 * force).norm(), 1e-3 * force.norm());
  double different = 0.0, moved = 0.0;
  for (int node = 0; node < single.lattice.nodeCount(); ++node) {
    const Vec3& u = single.state.displacement[at(node)];
    different += (twice.state.displacement[at(node)] - 2.0 * u).squaredNorm();
    moved += u.squaredNorm();
  }
  EXPECT_GT(countMoved(single.state), 30);
  EXPECT_LT(different, 1e-6 * moved);
}

// The terminating condition: the last raised layer is balanced, the next one is not disturbed.
TEST(PaperMethod, EndsWhereTheNextLayerIsNotDisturbed) {
  const PaperOptions options;
  PaperBlock block(kPressed, options);
  const std::vector<int> patch = middleOfTop(block.lattice);
  const Vec3 way(0.0, 0.0, -1e-3);
  LatticeState loaded = block.state;
  double greatest = 0.0;  // N, on a patch node before the layers give way
  for (const int node : patch) loaded.displacement[at(node)] = way;
  for (const int node : patch) {
    greatest = std::max(greatest, block.model.nodeForce(loaded, node).norm());
  }
  const SolveReport report = block.solve({displaced(patch, way)});
  ASSERT_EQ(report.status, SolveStatus::kOk);
  ASSERT_GT(report.layers, 2);
  const double balanced = options.balance_tolerance * greatest;
  const auto distance = [&](int node) {
    const auto n = block.lattice.gridIndex(node);
    const auto outside = [](int index) { return std::max({0, 8 - index, index - 12}); };
    return outside(n[0]) + outside(n[1]) + 10 - n[2];
  };
  int raised = 0, last = 0, next = 0;
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    if (block.lattice.isFixed(node)) continue;
    const Vec3& moved = block.state.displacement[at(node)];
    const double unbalanced = block.model.nodeForce(block.state, node).norm();
    if (distance(node) <= report.layers) ++raised;
    if (distance(node) == report.layers) {
      ++last;
      EXPECT_LE(unbalanced, balanced);
    } else if (distance(node) > report.layers) {
      EXPECT_TRUE(moved.isZero(0.0));
      if (distance(node) == report.layers + 1) ++next;
      EXPECT_LE(unbalanced, balanced);
    }
  }
  EXPECT_GT(last, 0);
  EXPECT_GT(next, 0);
  EXPECT_EQ(report.active_nodes, raised);
}

TEST(PaperMethod, FixedNodesNeverMove) {
  PaperBlock block(kPressed);
  press(block, 8, 1e-3);
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    if (!block.lattice.isFixed(node)) continue;
    EXPECT_TRUE(block.state.displacement[at(node)].isZero(0.0));
  }
}

// A column, its whole top moved by `way` along z: a bar under uniform stress. Iterated on, a
// compressed column of six springs a node buckles; it stays straight long enough when the strain
// is as small as here.
void expectBar(double way, const std::array<bool, 3>& free_axis) {
  const TissueConfig config = withFixedBottom(blockOf(1, 1, 10));
  PaperOptions options;
  options.passes = 1000;
  options.balance_tolerance = 1e-9;
  PaperBlock block(config, options);
  const double length = config.shape.max().z();
  LoadingPatch top = displaced(block.lattice.nodesIn(nodeBox(config, {0, 0, 10}, {1, 1, 10})),
                               Vec3(0.0, 0.0, way));
  top.free_axis = free_axis;
  const SolveReport report = block.solve({top});
  const double area = config.shape.max().x() * config.shape.max().y();
  const double expected = config.material.young_modulus * area * way / length;
  EXPECT_NEAR(report.patches.at(0).force.z(), expected, 1e-4 * std::abs(expected));
  double furthest = 0.0;
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    const Vec3 linear(0.0, 0.0, way * block.lattice.restPosition(node).z() / length);
    furthest = std::max(furthest, (block.state.displacement[at(node)] - linear).norm());
  }
  EXPECT_LT(furthest, 1e-4 * std::abs(way));
}

TEST(PaperMethod, IteratedConvergesToTheBarUnderAHeldTop) {
  expectBar(-1e-7, {{false, false, false}});
}

TEST(PaperMethod, IteratedConvergesToTheBarUnderASlidingTop) {
  expectBar(-1e-7, {{true, true, false}});
}

TEST(PaperMethod, IteratedConvergesToTheStretchedBar) { expectBar(1e-3, {{false, false, false}}); }

TEST(PaperMethod, TighterToleranceRaisesAtLeastAsManyLayers) {
  int layers = 0;
  std::set<int> seen;
  for (const double tolerance : {0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) {
    PaperOptions options;
    options.balance_tolerance = tolerance;
    PaperBlock block(kPressed, options);
    const SolveReport report =
        block.solve({displaced(middleOfTop(block.lattice), Vec3(0.0, 0.0, -1e-3))});
    EXPECT_GE(report.layers, layers) << tolerance;
    layers = report.layers;
    seen.insert(layers);
  }
  EXPECT_GT(seen.size(), 1u);
}

TEST(PaperMethod, ReportsWhenItRunsOutOfTime) {
  PaperOptions options;
  options.max_ms = 1e-9;
  PaperBlock block(kPressed, options);
  const LoadingPatch punch = displaced(middleOfTop(block.lattice), Vec3(0.0, 0.0, -1e-3));
  const SolveReport report = block.solve({punch});
  EXPECT_EQ(report.status, SolveStatus::kLate);
  EXPECT_GT(report.wall_ms, options.max_ms);
  for (const Vec3& moved : block.state.displacement) EXPECT_TRUE(moved.allFinite());

  PaperOptions patient;
  patient.max_ms = 1e6;
  PaperBlock relaxed(kPressed, patient);
  EXPECT_EQ(relaxed.solve({punch}).status, SolveStatus::kOk);
}

TEST(PaperMethod, WithoutLoadNothingMoves) {
  PaperBlock block(kPressed);
  const SolveReport report = block.solve({}, nodesOf(block.lattice));
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(countMoved(block.state), 0);
  EXPECT_EQ(report.layers, 0);
}

}  // namespace
}  // namespace robot_tissue::test_paper_method
