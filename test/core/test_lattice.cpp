// The constant model: numbering, springs, stiffness, mass, regions, boxes.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "block_fixtures.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_lattice {
namespace {

constexpr double kSpacing = 0.01;

TEST(Lattice, NumbersItsNodesWithXFastest) {
  TissueConfig config = blockOf(2, 3, 4);
  config.shape.min() += Vec3(1.0, 2.0, 3.0);
  config.shape.max() += Vec3(1.0, 2.0, 3.0);
  const Lattice lattice(config);
  ASSERT_EQ(lattice.size(), (std::array<int, 3>{3, 4, 5}));
  ASSERT_EQ(lattice.nodeCount(), 60);
  EXPECT_EQ(lattice.node(1, 0, 0), 1);
  EXPECT_EQ(lattice.node(0, 1, 0), 3);
  EXPECT_EQ(lattice.node(0, 0, 1), 12);
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const auto index = lattice.gridIndex(node);
    EXPECT_EQ(lattice.node(index[0], index[1], index[2]), node);
    const Vec3 expected = Vec3(1.0, 2.0, 3.0) + kSpacing * Vec3(index[0], index[1], index[2]);
    EXPECT_LT((lattice.restPosition(node) - expected).norm(), 1e-15);
  }
}

TEST(Lattice, HasOneSpringBetweenGridNeighbors) {
  for (const auto& cells : {std::array<int, 3>{1, 1, 1}, {2, 3, 4}, {7, 1, 2}}) {
    const Lattice lattice(blockOf(cells[0], cells[1], cells[2]));
    const int a = cells[0] + 1, b = cells[1] + 1, c = cells[2] + 1;
    EXPECT_EQ(static_cast<int>(lattice.springs().size()), 3 * a * b * c - a * b - b * c - c * a);
    std::set<std::pair<int, int>> pairs;
    for (const Spring& spring : lattice.springs()) {
      EXPECT_TRUE(pairs.emplace(spring.a, spring.b).second);
      const Vec3 along = lattice.restPosition(spring.b) - lattice.restPosition(spring.a);
      EXPECT_LT((along - kSpacing * Vec3::Unit(spring.axis)).norm(), 1e-15);
    }
  }
}

TEST(Lattice, NeighborsSeeEachOtherThroughTheSameSpring) {
  const Lattice lattice(blockOf(3, 2, 2));
  int seen = 0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    for (int direction = 0; direction < kNeighbors; ++direction) {
      const int neighbor = lattice.neighbor(node, direction);
      const int back = direction ^ 1;
      auto index = lattice.gridIndex(node);
      index[at(direction / 2)] += direction % 2 == 1 ? 1 : -1;
      const bool inside = index[at(direction / 2)] >= 0 &&
                          index[at(direction / 2)] < lattice.size()[at(direction / 2)];
      if (!inside) {
        EXPECT_EQ(neighbor, -1);
        EXPECT_EQ(lattice.springOf(node, direction), -1);
        continue;
      }
      ++seen;
      EXPECT_EQ(neighbor, lattice.node(index[0], index[1], index[2]));
      EXPECT_EQ(lattice.neighbor(neighbor, back), node);
      EXPECT_EQ(lattice.springOf(neighbor, back), lattice.springOf(node, direction));
    }
  }
  EXPECT_EQ(seen, 2 * static_cast<int>(lattice.springs().size()));
}

TissueConfig ballOf(double radius) {
  TissueConfig config = blockOf(1, 1, 1);
  config.model = "elastic";
  config.mesh = std::make_shared<const TriangleMesh>(sphereMesh(radius, 2));
  return config;
}

// A grid that is whole has no tables of its points, a ball's has.
TEST(Lattice, SpringsAreTheSameByNumberInTurnAndFromTheirNodes) {
  for (const TissueConfig& config : {blockOf(3, 2, 4), ballOf(0.03)}) {
    const Lattice lattice(config);
    int number = 0;
    for (const Spring spring : lattice.springs()) {
      EXPECT_EQ(spring.number, number++);
      const Spring again = lattice.springs()[at(spring.number)];
      EXPECT_EQ(again.a, spring.a);
      EXPECT_EQ(again.b, spring.b);
      EXPECT_EQ(again.axis, spring.axis);
      EXPECT_EQ(lattice.springOf(spring.a, 2 * spring.axis + 1), spring.number);
      EXPECT_EQ(lattice.springOf(spring.b, 2 * spring.axis), spring.number);
      EXPECT_EQ(lattice.neighbor(spring.a, 2 * spring.axis + 1), spring.b);
      EXPECT_EQ(lattice.neighbor(spring.b, 2 * spring.axis), spring.a);
    }
    EXPECT_EQ(number, static_cast<int>(lattice.springs().size()));
    EXPECT_GT(number, 0);
  }
}

// Slices of springs in series; parallel springs of a slice add up.
double barStiffness(const Lattice& lattice, int axis) {
  std::vector<double> slices(at(lattice.size()[at(axis)] - 1), 0.0);
  for (const Spring& spring : lattice.springs()) {
    if (spring.axis != axis) continue;
    slices[at(lattice.gridIndex(spring.a)[at(axis)])] += lattice.springStiffness(spring);
  }
  double compliance = 0.0;
  for (const double slice : slices) compliance += 1.0 / slice;
  return 1.0 / compliance;
}

TEST(Lattice, BarOfAnyCrossSectionHasTheStiffnessOfItsModulus) {
  for (const auto& cells : {std::array<int, 3>{1, 1, 10}, {4, 1, 3}, {2, 5, 3}, {6, 6, 1}}) {
    const TissueConfig config = blockOf(cells[0], cells[1], cells[2]);
    const Lattice lattice(config);
    for (int axis = 0; axis < 3; ++axis) {
      const double length = config.shape.max()[axis];
      const double area = config.shape.max().prod() / length;
      const double expected = config.material.young_modulus * area / length;
      EXPECT_NEAR(barStiffness(lattice, axis), expected, 1e-9 * expected);
    }
  }
}

TEST(Lattice, SpringConstantIsThatOfEverySpring) {
  TissueConfig config = blockOf(3, 4, 2);
  config.material.spring_stiffness = 50.0;
  const Lattice lattice(config);
  for (const Spring& spring : lattice.springs())
    EXPECT_DOUBLE_EQ(lattice.springStiffness(spring), 50.0);
}

TEST(Lattice, LaterRegionWins) {
  TissueConfig config = blockOf(8, 4, 4);
  Region left{"left", nodeBox(config, {0, 0, 0}, {6, 4, 4}), nullptr, config.material};
  Region right{"right", nodeBox(config, {4, 0, 0}, {8, 4, 4}), nullptr, config.material};
  left.material.young_modulus = 2e4;
  right.material.young_modulus = 5e4;
  right.material.density = 3000.0;
  config.regions = {left, right};
  const Lattice lattice(config);
  const auto innerStiffness = [&](int i, int direction) {
    const int spring = lattice.springOf(lattice.node(i, 2, 2), direction);
    return lattice.springStiffness(lattice.springs()[at(spring)]);
  };
  EXPECT_NEAR(innerStiffness(3, 1), 2e4 * kSpacing, 1e-9);
  EXPECT_NEAR(innerStiffness(5, 1), 5e4 * kSpacing, 1e-9);
  EXPECT_NEAR(innerStiffness(4, 5), 0.5 * (2e4 + 5e4) * kSpacing, 1e-9);  // on the border
  EXPECT_NEAR(lattice.mass(lattice.node(2, 2, 2)), 1000.0 * std::pow(kSpacing, 3), 1e-12);
  EXPECT_NEAR(lattice.mass(lattice.node(6, 2, 2)), 3000.0 * std::pow(kSpacing, 3), 1e-12);

  config.regions = {right, left};
  const Lattice swapped(config);
  const int overlap = swapped.springOf(swapped.node(5, 2, 2), 5);
  EXPECT_NEAR(swapped.springStiffness(swapped.springs()[at(overlap)]), 2e4 * kSpacing, 1e-9);
}

TEST(Lattice, WeighsAsMuchAsItsVolume) {
  TissueConfig config = blockOf(3, 4, 5);
  config.material.density = 1100.0;
  const Lattice lattice(config);
  double mass = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) mass += lattice.mass(node);
  EXPECT_NEAR(mass, 1100.0 * config.shape.max().prod(), 1e-12);
  EXPECT_NEAR(lattice.mass(0), 1100.0 * std::pow(kSpacing, 3) / 8.0, 1e-15);  // a corner
}

TEST(Lattice, BoxesAreClosedWithSlackOfAThousandthOfTheSpacing) {
  const TissueConfig config = blockOf(4, 4, 4);
  const Lattice lattice(config);
  EXPECT_EQ(
      lattice.nodesIn(nodeBox(config, {1, 1, 1}, {3, 2, 1})),
      (std::vector<int>{lattice.node(1, 1, 1), lattice.node(2, 1, 1), lattice.node(3, 1, 1),
                        lattice.node(1, 2, 1), lattice.node(2, 2, 1), lattice.node(3, 2, 1)}));
  for (int axis = 0; axis < 3; ++axis) {
    Box box = nodeBox(config, {2, 2, 2}, {2, 2, 2});
    box.min()[axis] += 0.9e-3 * kSpacing;
    box.max()[axis] += 0.5 * kSpacing;
    EXPECT_EQ(lattice.nodesIn(box).size(), 1u);
    box.min()[axis] += 0.2e-3 * kSpacing;
    EXPECT_TRUE(lattice.nodesIn(box).empty());
    box.max()[axis] = (3.0 - 0.9e-3) * kSpacing;
    EXPECT_EQ(lattice.nodesIn(box).size(), 1u);
    box.max()[axis] = (3.0 - 1.1e-3) * kSpacing;
    EXPECT_TRUE(lattice.nodesIn(box).empty());
  }
  EXPECT_EQ(lattice.nodesIn(everywhere()).size(), 125u);
  EXPECT_TRUE(lattice.nodesIn({Vec3::Constant(1.0), Vec3::Constant(2.0)}).empty());
  EXPECT_TRUE(lattice.nodesIn({Vec3::Constant(-2.0), Vec3::Constant(-1.0)}).empty());
  EXPECT_TRUE(lattice.nodesIn({Vec3::Constant(0.03), Vec3::Constant(0.01)}).empty());
}

TEST(Lattice, FixesTheNodesOfItsBoxesOnly) {
  const Lattice lattice(withFixedBottom(blockOf(3, 3, 3)));
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    EXPECT_EQ(lattice.isFixed(node), lattice.gridIndex(node)[2] == 0);
  }
}

TEST(Lattice, RestStateIsWholeAndUndisplaced) {
  const Lattice lattice(blockOf(2, 2, 2));
  const LatticeState state = lattice.restState();
  ASSERT_EQ(state.displacement.size(), at(lattice.nodeCount()));
  ASSERT_EQ(state.severed.size(), lattice.springs().size());
  for (const Vec3& moved : state.displacement) EXPECT_TRUE(moved.isZero(0.0));
  for (const auto severed : state.severed) EXPECT_EQ(severed, 0);
  EXPECT_EQ(state.springs_cut, 0);
  EXPECT_EQ(state.pieces, 1);
}

TEST(Lattice, RefusesSpacingThatDoesNotDivideTheShape) {
  TissueConfig config = blockOf(4, 4, 4);
  config.spacing = 0.003;
  const std::string line = inputErrorOf([&] { const Lattice lattice(config); });
  EXPECT_TRUE(isOneLine(line)) << line;
  EXPECT_TRUE(mentions(line, "tissue.spacing")) << line;
  EXPECT_TRUE(mentions(line, "0.003")) << line;
  EXPECT_TRUE(mentions(line, "allowed")) << line;
}

TEST(Lattice, RefusesSpacingThatIsNoLength) {
  for (const double spacing : {-0.01, 0.05, 0.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
    TissueConfig config = blockOf(4, 4, 4);
    config.spacing = spacing;
    EXPECT_THROW(const Lattice lattice(config), InputError) << spacing;
  }
}

TEST(Lattice, RefusesFixedBoxWithoutNode) {
  TissueConfig config = withFixedBottom(blockOf(4, 4, 4));
  config.fixed.push_back({Vec3::Constant(1.0), Vec3::Constant(2.0)});
  const std::string line = inputErrorOf([&] { const Lattice lattice(config); });
  EXPECT_TRUE(isOneLine(line)) << line;
  EXPECT_TRUE(mentions(line, "tissue.fixed[1]")) << line;
  EXPECT_TRUE(mentions(line, "allowed")) << line;
}

}  // namespace
}  // namespace robot_tissue::test_lattice
