// Cutting: which springs a polygon severs, in the deformed shape; pieces.
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "block_fixtures.h"
#include "cutting/cut.h"
#include "lattice/connectivity.h"

namespace robot_tissue::test_cut {
namespace {

constexpr double kSpacing = 0.01;

using Corners = std::vector<Vec3>;

// A rectangle across `axis` at `height` (m) that reaches `beyond` (m) past the origin-based block
// on all sides.
Corners acrossBlock(const TissueConfig& config, int axis, double height, double beyond = 0.05) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Corners corners(4, Vec3::Zero());
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i][axis] = height;
    corners[i][u] = i == 1 || i == 2 ? config.shape.max()[u] + beyond : -beyond;
    corners[i][v] = i >= 2 ? config.shape.max()[v] + beyond : -beyond;
  }
  return corners;
}

Corners reversed(Corners corners) { return {corners.rbegin(), corners.rend()}; }

TEST(Cut, PlaneBetweenNodesSeversOneSpringOfEveryRow) {
  const TissueConfig config = blockOf(3, 4, 5);
  const Lattice lattice(config);
  for (int axis = 0; axis < 3; ++axis) {
    LatticeState state = lattice.restState();
    const auto crossing =
        springsOf(springsAcross(lattice, state, acrossBlock(config, axis, 1.3 * kSpacing)));
    const auto& size = lattice.size();
    EXPECT_EQ(static_cast<int>(crossing.size()),
              size[at((axis + 1) % 3)] * size[at((axis + 2) % 3)]);
    for (const int spring : crossing) {
      EXPECT_EQ(lattice.springs()[at(spring)].axis, axis);
      EXPECT_EQ(lattice.gridIndex(lattice.springs()[at(spring)].a)[at(axis)], 1);
    }
    sever(lattice, halfWay(crossing), state);
    EXPECT_EQ(countPieces(lattice, state), 2);
  }
}

TEST(Cut, PlaneThroughNodesSeversOneSpringOfEveryRow) {
  const TissueConfig config = blockOf(4, 3, 3);
  const Lattice lattice(config);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double off : {0.0, 1e-12, -1e-12, 0.5e-3 * kSpacing, -0.5e-3 * kSpacing}) {
      for (const bool turned : {false, true}) {
        Corners corners = acrossBlock(config, axis, 2.0 * kSpacing + off);
        if (turned) corners = reversed(corners);
        LatticeState state = lattice.restState();
        const auto crossing = springsOf(springsAcross(lattice, state, corners));
        const auto& size = lattice.size();
        EXPECT_EQ(static_cast<int>(crossing.size()),
                  size[at((axis + 1) % 3)] * size[at((axis + 2) % 3)]);
        EXPECT_EQ(std::set<int>(crossing.begin(), crossing.end()).size(), crossing.size());
        for (const int spring : crossing) {
          // The nodes on the plane belong to the side that the normal looks to.
          EXPECT_EQ(lattice.gridIndex(lattice.springs()[at(spring)].a)[at(axis)], turned ? 2 : 1);
        }
        sever(lattice, halfWay(crossing), state);
        EXPECT_EQ(countPieces(lattice, state), 2);
      }
    }
  }
}

// Told without the slack that decides on which side a node is, so to the last digits.
TEST(Cut, TellsWhereInTheSpringsTheBladePasses) {
  const TissueConfig config = blockOf(4, 3, 3);
  const Lattice lattice(config);
  const LatticeState state = lattice.restState();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double along : {0.0, 0.1, 0.3, 0.75}) {
      const Corners flat = acrossBlock(config, axis, (1.0 + along) * kSpacing);
      Corners bent = flat;  // by less than a hair, but not flat
      bent[0][axis] += 2e-3 * kSpacing;
      for (const Crossing& each : springsAcross(lattice, state, flat)) {
        const bool below = lattice.gridIndex(lattice.springs()[at(each.spring)].a)[at(axis)] == 0;
        EXPECT_NEAR(each.along, below ? along + 1.0 : along, 1e-9);
      }
      for (const Crossing& each : springsAcross(lattice, state, bent)) {
        const bool below = lattice.gridIndex(lattice.springs()[at(each.spring)].a)[at(axis)] == 0;
        EXPECT_NEAR(each.along, below ? along + 1.0 : along, 2.1e-3);
      }
    }
  }
}

TEST(Cut, DiagonalPlaneThroughNodesSeparates) {
  const Lattice lattice(blockOf(4, 4, 2));
  LatticeState state = lattice.restState();
  const auto crossing = springsAcross(
      lattice, state,
      {{-0.01, -0.01, -0.01}, {0.05, 0.05, -0.01}, {0.05, 0.05, 0.03}, {-0.01, -0.01, 0.03}});
  // Each of the 5 nodes of the diagonal, of 3 layers, loses its springs to one side: 4 along x, 4
  // along y.
  EXPECT_EQ(crossing.size(), 3u * 8u);
  sever(lattice, crossing, state);
  EXPECT_EQ(countPieces(lattice, state), 2);
}

TEST(Cut, SeveredSpringsAreNotCutAgain) {
  const TissueConfig config = blockOf(3, 3, 3);
  const Lattice lattice(config);
  LatticeState state = lattice.restState();
  const Corners corners = acrossBlock(config, 2, 1.5 * kSpacing);
  sever(lattice, springsAcross(lattice, state, corners), state);
  ASSERT_EQ(state.springs_cut, 16);
  EXPECT_TRUE(springsAcross(lattice, state, corners).empty());
}

TEST(Cut, SmallPolygonSeversWhatItCoversOnly) {
  const Lattice lattice(blockOf(6, 6, 2));
  const double z = 0.5 * kSpacing;
  const auto crossing =
      springsAcross(lattice, lattice.restState(),
                    {{0.015, 0.005, z}, {0.045, 0.005, z}, {0.045, 0.025, z}, {0.015, 0.025, z}});
  std::set<std::array<int, 3>> below;
  for (const Crossing& each : crossing)
    below.insert(lattice.gridIndex(lattice.springs()[at(each.spring)].a));
  EXPECT_EQ(below, (std::set<std::array<int, 3>>{
                       {2, 1, 0}, {3, 1, 0}, {4, 1, 0}, {2, 2, 0}, {3, 2, 0}, {4, 2, 0}}));
}

// An L over 6 x 6 columns of nodes:   . . . . .
//                                     x x . . .
//                                     x x . . .
//                                     x x x x .
TEST(Cut, NotchOfANonConvexPolygonIsSpared) {
  const Lattice lattice(blockOf(5, 5, 2));
  const double z = 0.5 * kSpacing;
  Corners ell = {{-0.005, -0.005, z}, {0.035, -0.005, z}, {0.035, 0.005, z},
                 {0.015, 0.005, z},   {0.015, 0.025, z},  {-0.005, 0.025, z}};
  for (const bool turned : {false, true}) {
    if (turned) ell = reversed(ell);
    std::set<std::array<int, 3>> below;
    for (const auto& each : springsAcross(lattice, lattice.restState(), ell)) {
      below.insert(lattice.gridIndex(lattice.springs()[at(each.spring)].a));
    }
    EXPECT_EQ(below, (std::set<std::array<int, 3>>{{0, 0, 0},
                                                   {1, 0, 0},
                                                   {2, 0, 0},
                                                   {3, 0, 0},
                                                   {0, 1, 0},
                                                   {1, 1, 0},
                                                   {0, 2, 0},
                                                   {1, 2, 0}}));
  }
}

TEST(Cut, PolygonBesideTheBlockSeversNothing) {
  const TissueConfig config = blockOf(3, 3, 3);
  const Lattice lattice(config);
  const LatticeState state = lattice.restState();
  EXPECT_TRUE(springsAcross(lattice, state, acrossBlock(config, 0, -0.01)).empty());
  EXPECT_TRUE(springsAcross(lattice, state, acrossBlock(config, 2, 0.031)).empty());
  Corners beside = acrossBlock(config, 0, 0.015);
  for (Vec3& corner : beside) corner.y() += 0.2;
  EXPECT_TRUE(springsAcross(lattice, state, beside).empty());
}

// The same plane severs another slice of springs once the nodes have moved under it.
TEST(Cut, CutsInTheDeformedShape) {
  const TissueConfig config = blockOf(4, 2, 2);
  const Lattice lattice(config);
  LatticeState state = lattice.restState();
  for (Vec3& moved : state.displacement) moved.x() = -1.0 * kSpacing;
  const auto crossing =
      springsOf(springsAcross(lattice, state, acrossBlock(config, 0, 0.5 * kSpacing)));
  ASSERT_EQ(crossing.size(), 9u);
  for (const int spring : crossing) {
    EXPECT_EQ(lattice.gridIndex(lattice.springs()[at(spring)].a)[0], 1);
  }
  // Sheared by 45 degrees, a plane across x meets springs along z as well.
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    state.displacement[at(node)] = Vec3(lattice.restPosition(node).z(), 0.0, 0.0);
  }
  std::array<int, 3> cut_along{};
  for (const auto& each : springsAcross(lattice, state, acrossBlock(config, 0, 2.5 * kSpacing))) {
    ++cut_along[at(lattice.springs()[at(each.spring)].axis)];
  }
  EXPECT_EQ(cut_along, (std::array<int, 3>{9, 0, 6}));
}

TEST(Cut, RefusesBadPolygonsInOneLine) {
  const Lattice lattice(blockOf(3, 3, 3));
  const LatticeState state = lattice.restState();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<Corners> bad = {{},
                                    {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}},
                                    {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.02, 0.0, 0.0}},
                                    {{0.01, 0.01, 0.01}, {0.01, 0.01, 0.01}, {0.01, 0.01, 0.01}},
                                    {{0.0, 0.0, 0.0}, {0.01, nan, 0.0}, {0.0, 0.02, 0.0}},
                                    {{0.0, 0.0, 0.0}, {inf, 0.0, 0.0}, {0.0, 0.02, 0.0}}};
  for (const Corners& corners : bad) {
    const std::string line = inputErrorOf([&] { springsAcross(lattice, state, corners); });
    EXPECT_TRUE(isOneLine(line)) << line;
    EXPECT_TRUE(mentions(line, "corners")) << line;
    EXPECT_TRUE(mentions(line, "allowed")) << line;
  }
}

TEST(CountPieces, CountsWhatSpringsHoldTogether) {
  const TissueConfig config = blockOf(3, 3, 3);
  const Lattice lattice(config);
  LatticeState state = lattice.restState();
  EXPECT_EQ(countPieces(lattice, state), 1);
  sever(lattice, springsAcross(lattice, state, acrossBlock(config, 0, 1.5 * kSpacing)), state);
  sever(lattice, springsAcross(lattice, state, acrossBlock(config, 1, 1.5 * kSpacing)), state);
  sever(lattice, springsAcross(lattice, state, acrossBlock(config, 2, 1.5 * kSpacing)), state);
  EXPECT_EQ(countPieces(lattice, state), 8);
  state.severed.assign(state.severed.size(), 1);
  EXPECT_EQ(countPieces(lattice, state), lattice.nodeCount());
}

}  // namespace
}  // namespace robot_tissue::test_cut
