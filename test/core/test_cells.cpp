// Cells: corners, parts of cut ones, inverted ones.
#include <gtest/gtest.h>

#include <numeric>

#include "block_fixtures.h"
#include "cutting/cut.h"
#include "cutting/split_cells.h"
#include "robot_tissue/core/cells.h"

namespace robot_tissue::test_cells {
namespace {

constexpr double kSpacing = 0.01;

void sever(const Lattice& lattice, LatticeState& state, int node, int direction) {
  sever(lattice, halfWay({lattice.springOf(node, direction)}), state);
}

TEST(Cells, CornersAreNumberedByTheirBits) {
  const Lattice lattice(blockOf(3, 3, 3));
  const auto corners = lattice.cells()[at(lattice.cellAt({1, 2, 0}))].nodes;
  for (int corner = 0; corner < kCorners; ++corner) {
    const auto index = lattice.gridIndex(corners[at(corner)]);
    EXPECT_EQ(index, (std::array<int, 3>{1 + corner % 2, 2 + corner / 2 % 2, corner / 4}));
  }
}

TEST(Cells, WholeCellIsOnePart) {
  const Lattice lattice(blockOf(1, 1, 1));
  const LatticeState state = lattice.restState();
  EXPECT_EQ(cellParts(lattice, state, lattice.cells().front().nodes),
            (std::array<int, kCorners>{}));
}

TEST(Cells, CutThroughAllSpringsOfADirectionMakesTwoParts) {
  const Lattice lattice(blockOf(1, 1, 1));
  for (int axis = 0; axis < 3; ++axis) {
    LatticeState state = lattice.restState();
    for (int corner = 0; corner < kCorners; ++corner) {
      if ((corner >> axis & 1) == 0) sever(lattice, state, corner, 2 * axis + 1);
    }
    ASSERT_EQ(state.springs_cut, 4);
    const auto parts = cellParts(lattice, state, lattice.cells().front().nodes);
    for (int corner = 0; corner < kCorners; ++corner) {
      EXPECT_EQ(parts[at(corner)], (corner >> axis & 1) != 0 ? 1 << axis : 0);
    }
  }
}

TEST(Cells, ThreeOfFourSpringsCutLeaveOnePart) {
  const Lattice lattice(blockOf(1, 1, 1));
  LatticeState state = lattice.restState();
  for (const int corner : {0, 2, 4}) sever(lattice, state, corner, 1);
  EXPECT_EQ(cellParts(lattice, state, lattice.cells().front().nodes),
            (std::array<int, kCorners>{}));
}

TEST(Cells, CornerThatLostItsThreeSpringsIsAPartOfItsOwn) {
  const Lattice lattice(blockOf(1, 1, 1));
  LatticeState state = lattice.restState();
  for (const int direction : {0, 2, 4}) sever(lattice, state, 7, direction);
  const auto parts = cellParts(lattice, state, lattice.cells().front().nodes);
  for (int corner = 0; corner < 7; ++corner) EXPECT_EQ(parts[at(corner)], 0);
  EXPECT_EQ(parts[7], 7);
}

TEST(Cells, AllSpringsCutMakeEightParts) {
  const Lattice lattice(blockOf(1, 1, 1));
  LatticeState state = lattice.restState();
  std::vector<int> all(state.severed.size());
  std::iota(all.begin(), all.end(), 0);
  sever(lattice, halfWay(all), state);
  const auto parts = cellParts(lattice, state, lattice.cells().front().nodes);
  for (int corner = 0; corner < kCorners; ++corner) EXPECT_EQ(parts[at(corner)], corner);
}

TEST(InvertedCells, RestShapeHasNone) {
  const Lattice lattice(blockOf(3, 3, 3));
  EXPECT_EQ(countInvertedCells(lattice, lattice.restState()), 0);
}

// One cell; its top face is pushed down and through its bottom face.
TEST(InvertedCells, FacePushedThroughTheOppositeOneInvertsTheCell) {
  const Lattice lattice(blockOf(1, 1, 1));
  for (const auto& [way, inverted] : {std::pair(0.99, 0), {1.01, 1}}) {
    LatticeState state = lattice.restState();
    for (int corner = 4; corner < 8; ++corner) {
      state.displacement[at(corner)].z() = -way * kSpacing;
    }
    EXPECT_EQ(countInvertedCells(lattice, state), inverted) << way;
  }
}

// The mean of a cell turns over when the four edges along z add up to nothing: one node 4 spacings
// down. It belongs to four cells of the upper layer, and pulls open the four below.
TEST(InvertedCells, NodePushedFarThroughTheOppositeFaceInvertsTheCellsAboveIt) {
  const Lattice lattice(blockOf(2, 2, 2));
  for (const auto& [way, inverted] : {std::pair(3.99, 0), {4.01, 4}}) {
    LatticeState state = lattice.restState();
    state.displacement[at(lattice.node(1, 1, 2))].z() = -way * kSpacing;
    EXPECT_EQ(countInvertedCells(lattice, state), inverted) << way;
  }
}

TEST(InvertedCells, RotationAndShearInvertNone) {
  const Lattice lattice(blockOf(2, 2, 2));
  LatticeState rotated = lattice.restState(), sheared = lattice.restState();
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(3.0, Vec3::UnitX()));
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    rotated.displacement[at(node)] = turn * rest - rest;
    sheared.displacement[at(node)] = Vec3(5.0 * rest.z(), 0.0, 0.0);
  }
  EXPECT_EQ(countInvertedCells(lattice, rotated), 0);
  EXPECT_EQ(countInvertedCells(lattice, sheared), 0);
}

TEST(InvertedCells, MirrorImageInvertsAll) {
  const Lattice lattice(blockOf(3, 2, 2));
  LatticeState state = lattice.restState();
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    state.displacement[at(node)].x() = -2.0 * lattice.restPosition(node).x();
  }
  EXPECT_EQ(countInvertedCells(lattice, state), 12);
}

TEST(InvertedCells, HalvesOfACutCellMayPassEachOther) {
  const Lattice lattice(blockOf(1, 1, 1));
  LatticeState state = lattice.restState();
  for (int corner = 0; corner < 4; ++corner) sever(lattice, state, corner, 5);
  for (int corner = 4; corner < 8; ++corner) state.displacement[at(corner)].z() = -2.0 * kSpacing;
  EXPECT_EQ(countInvertedCells(lattice, state), 0);
}

}  // namespace
}  // namespace robot_tissue::test_cells
