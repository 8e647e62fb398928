// Nodes that carry little tissue, and how they count in lengths.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "block_fixtures.h"
#include "cutting/cut.h"
#include "solvers/multigrid/hierarchy/light_nodes.h"
#include "solvers/multigrid/level/grid_level.h"

namespace robot_tissue::test_light_nodes {
namespace {

TEST(LightNodes, FullBlocksHaveNone) {
  const Lattice lattice(blockOf(3, 2, 2));
  EXPECT_TRUE(lightNodes(*lattice.restState().cells).empty());
}

// What is cut through the middles of springs counts whole.
TEST(LightNodes, AreNoneBesideACutInTheMiddle) {
  const Lattice lattice(blockOf(1, 1, 1));
  LatticeState state = lattice.restState();
  std::vector<int> springs(state.severed.size());
  std::iota(springs.begin(), springs.end(), 0);
  sever(lattice, halfWay(springs), state, SplitCells::kParted);
  ASSERT_EQ(state.cells->ghosts().size(), 56U) << "eight parts with a corner each";
  EXPECT_TRUE(lightNodes(*state.cells).empty());
}

// Of 2 x 2 cells and three layers, the uppermost parted so that a hundredth of it is above the
// blade. In height t of a cell, a column of area 1 carries, by trilinear shape functions:
//   at a level, the integral of t or 1 - t over the part's height.
TEST(LightNodes, WeighWhatTheyCarryBesideACut) {
  const Lattice lattice(blockOf(2, 2, 3));
  LatticeState state = lattice.restState();
  const double height = 2.99 * lattice.spacing(), far = 1.0;
  sever(lattice,
        springsAcross(
            lattice, state,
            {{-far, -far, height}, {far, -far, height}, {far, far, height}, {-far, far, height}}),
        state, SplitCells::kParted);
  const CellSet& cells = *state.cells;
  ASSERT_EQ(cells.ghosts().size(), 18U);
  const double ghost_above = 0.01 * 0.01 / 2, own_above = 0.01 - ghost_above;  // of the thin part
  const double ghost_below = 0.99 * 0.99 / 2;
  std::vector<double> expected(static_cast<std::size_t>(cells.nodeCount()), 1.0);
  for (int node = 0; node < cells.nodeCount(); ++node) {
    const auto place = lattice.gridIndex(cells.original(node));
    double column = 1.0;  // in areas of a cell's face
    for (std::size_t axis = 0; axis < 2; ++axis) column *= place[axis] == 1 ? 1.0 : 0.5;
    double height_carried = place[2] == 0 ? 0.5 : 1.0;
    if (cells.isGhost(node)) height_carried = place[2] == 2 ? ghost_above : ghost_below;
    if (!cells.isGhost(node) && place[2] == 3) height_carried = own_above;
    expected[at(node)] = std::min(1.0, 512.0 * column * height_carried);
  }
  for (const LightNode& light : lightNodes(cells)) {
    EXPECT_NEAR(light.weight, expected[at(light.node)], 1e-9);
    EXPECT_LT(light.weight, 1.0);
    expected[at(light.node)] = 1.0;
  }
  for (const double weight : expected) EXPECT_NEAR(weight, 1.0, 1e-9) << "light, but not told";
}

TEST(WeightRoots, MakeNodesCountLessInLengths) {
  const LevelGrid grid({2, 2, 2});
  LevelCell cell;
  for (int corner = 0; corner < kCorners; ++corner) {
    cell.nodes[at(corner)] = grid.index(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  }
  cell.shear = cell.bulk = 1.0;
  GridLevel<double> level(grid, 0, {cell}, {grid.whole(), GridBox()});
  const auto count = at(level.count());
  Field<double> motion;
  for (auto& values : motion) values.assign(count, 0.0);
  motion[0][at(grid.index(0, 0, 0))] = 3.0;
  motion[2][at(grid.index(1, 1, 1))] = 4.0;
  level.displacement = motion;
  level.findForces();
  const double local = level.squaredLocalMotion();
  Field<double> rest;
  for (auto& values : rest) values.assign(count, 0.0);
  EXPECT_DOUBLE_EQ(level.squaredLength(motion), 25.0);
  EXPECT_DOUBLE_EQ(level.squaredDistanceFrom(rest), 25.0);

  Numbers<double> roots(count, 0.5);
  level.setWeightRoots(roots);
  EXPECT_NEAR(level.squaredLocalMotion(), 0.25 * local, 1e-12 * local);
  roots.assign(count, 1.0);
  roots[at(grid.index(0, 0, 0))] = 0.1;
  level.setWeightRoots(roots);
  EXPECT_NEAR(level.squaredLength(motion), 16.09, 1e-12);
  EXPECT_NEAR(level.squaredDistanceFrom(rest), 16.09, 1e-12);
}

}  // namespace
}  // namespace robot_tissue::test_light_nodes
