// Lattices of twice the spacing: same volume, same neighbors, parted where cuts have parted.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "solvers/multigrid/level/lattice_coarsening.h"

namespace robot_tissue::test_lattice_coarsening {
namespace {

std::vector<LevelCell> blockOf(const LevelGrid& grid) {
  std::vector<LevelCell> cells;
  for (int k = 0; k + 1 < grid.size[2]; ++k) {
    for (int j = 0; j + 1 < grid.size[1]; ++j) {
      for (int i = 0; i + 1 < grid.size[0]; ++i) {
        LevelCell cell{{i, j, k}, {}, 1.0, 2.0, 0.0, {}, {}};
        for (int corner = 0; corner < kCorners; ++corner) {
          cell.nodes[at(corner)] =
              grid.index(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
        }
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

// Cells from place x on have nodes of their own at that plane: cut through.
void cutAt(int x, const LevelGrid& grid, std::vector<LevelCell>& cells) {
  for (LevelCell& cell : cells) {
    for (int corner = 0; corner < kCorners; ++corner) {
      int& node = cell.nodes[at(corner)];
      const auto place = grid.placeOf(node);
      if (cell.place[0] >= x && place[0] == x) {
        node = grid.beside + place[1] + grid.size[1] * place[2];
      }
    }
  }
}

double shearOf(const std::vector<LevelCell>& cells) {
  double sum = 0.0;
  for (const LevelCell& cell : cells) sum += cell.shear;
  return sum;
}

TEST(Coarsening, OfABlockIsTheBlockOfTwiceTheSpacing) {
  const LevelGrid grid({5, 7, 3});
  const auto cells = blockOf(grid);
  const Coarsening coarse = coarsened(grid, cells, grid.beside);
  EXPECT_EQ(coarse.grid.size, (std::array<int, 3>{3, 4, 2}));
  EXPECT_EQ(coarse.nodes_beside, 0);
  EXPECT_TRUE(coarse.carried.empty());
  EXPECT_TRUE(coarse.starts.empty());
  ASSERT_EQ(coarse.cells.size(), 6U);
  for (const LevelCell& cell : coarse.cells) EXPECT_EQ(cell.shear, 1.0);
}

// With one cell in part, coarse cells are filled where theirs are: the octants but the last.
TEST(Coarsening, CoarseCellIsFilledWhereItsCellsAre) {
  const LevelGrid grid({3, 3, 3});
  std::vector<LevelCell> cells = blockOf(grid);
  cells.pop_back();
  cells.front().fill = levelFill(CellFill(), 1.0, 2.0);
  const Coarsening coarse = coarsened(grid, cells, grid.beside);
  ASSERT_EQ(coarse.cells.size(), 1U);
  ASSERT_NE(coarse.cells.front().fill, nullptr);
  const FillIntegrals& sum = coarse.cells.front().fill->integrals;
  const FillIntegrals expected = octantIntegrals(0x7f);
  EXPECT_NEAR(sum.volume, expected.volume, 1e-14);
  EXPECT_LT((sum.first - expected.first).norm(), 1e-14);
  EXPECT_LT((sum.second - expected.second).norm(), 1e-14);
  EXPECT_LT((coarse.cells.front().fill->law.centroid - fillOf(expected).centroid).norm(), 1e-14);
  // Of seven middles at +-1/4, of which one more along each axis is low.
  EXPECT_LT((coarse.cells.front().fill->between_parts - Vec3::Constant(3.0 / 49.0)).norm(), 1e-14);
}

TEST(Coarsening, OfAnOddBlockKeepsItsVolumeAndStartsItsOuterNodesFromThoseNextToThem) {
  const LevelGrid grid({4, 5, 5});
  const auto cells = blockOf(grid);
  const Coarsening coarse = coarsened(grid, cells, grid.beside);
  EXPECT_EQ(coarse.grid.size, (std::array<int, 3>{3, 3, 3}));
  EXPECT_DOUBLE_EQ(8.0 * shearOf(coarse.cells), shearOf(cells));
  EXPECT_EQ(coarse.starts.size(), 9U);
  for (const Coarsening::Start& start : coarse.starts) {
    double sum = 0.0;
    for (const NodeWeight& share : start.fine) {
      EXPECT_EQ(grid.placeOf(share.node)[0], 3);
      sum += share.weight;
    }
    EXPECT_DOUBLE_EQ(sum, 1.0);
  }
}

TEST(Coarsening, WhatACutPartsStaysPartedWhereverTheCutRuns) {
  for (const int x : {2, 3, 4}) {
    const LevelGrid grid({7, 5, 5});
    auto cells = blockOf(grid);
    cutAt(x, grid, cells);
    const Coarsening coarse = coarsened(grid, cells, grid.beside + 25);
    EXPECT_DOUBLE_EQ(8.0 * shearOf(coarse.cells), shearOf(cells));
    // Nodes of coarse cells that stand for cells on one side, and on the other.
    std::set<int> nodes[2];
    for (const LevelCell& cell : cells) {
      std::set<int>& side = nodes[cell.place[0] >= x ? 1 : 0];
      for (const int node : cell.nodes) {
        const auto found = std::find_if(coarse.carried.begin(), coarse.carried.end(),
                                        [node](const auto& each) { return each.node == node; });
        const NodeShares shares = found != coarse.carried.end()
                                      ? found->carriers
                                      : sharesAround(coarse.grid, grid.placeOf(node));
        for (const NodeWeight& share : shares) side.insert(share.node);
      }
    }
    for (const int node : nodes[0]) EXPECT_EQ(nodes[1].count(node), 0U) << "cut at " << x;
  }
}

TEST(Coarsening, AroundAPlaceWeightsSumToOne) {
  const LevelGrid coarse({4, 4, 4});
  EXPECT_EQ(sharesAround(coarse, {2, 4, 0}).size(), 1U);
  const NodeShares shares = sharesAround(coarse, {3, 5, 1});
  EXPECT_EQ(shares.size(), 8U);
  for (const NodeWeight& share : shares) EXPECT_EQ(share.weight, 0.125);
}

}  // namespace
}  // namespace robot_tissue::test_lattice_coarsening
