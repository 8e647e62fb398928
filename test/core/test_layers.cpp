// Layers are sets of equal graph distance to the seeds along uncut springs (paper, figure 2).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "block_fixtures.h"
#include "solvers/paper/layers.h"

namespace robot_tissue::test_layers {
namespace {

constexpr int kNever = -1;

// Layer of each node by walking; kNever where the walk does not come. Counts a node that comes
// twice as an error.
std::vector<int> layersByWalk(LayerWalk& walk, const Lattice& lattice, const LatticeState& state) {
  std::vector<int> layer_of(at(lattice.nodeCount()), kNever);
  int layer = 0;
  for (auto nodes = walk.next(state); !nodes.empty(); nodes = walk.next(state)) {
    ++layer;
    for (const int node : nodes) {
      EXPECT_EQ(layer_of[at(node)], kNever) << "node " << node << " is in two layers";
      layer_of[at(node)] = layer;
    }
  }
  return layer_of;
}

// The same by relaxing distances over the list of springs, fixed nodes left out.
std::vector<int> distancesBySprings(const Lattice& lattice, const LatticeState& state,
                                    const std::vector<int>& seeds) {
  const int far = lattice.nodeCount();
  std::vector<int> distance(at(lattice.nodeCount()), far);
  for (const int seed : seeds) distance[at(seed)] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t index = 0; index < lattice.springs().size(); ++index) {
      const Spring& spring = lattice.springs()[index];
      if (state.severed[index] != 0) continue;
      if (lattice.isFixed(spring.a) || lattice.isFixed(spring.b)) continue;
      int& a = distance[at(spring.a)];
      int& b = distance[at(spring.b)];
      const int nearer = std::min(a, b) + 1;
      changed = changed || nearer < std::max(a, b);
      a = std::min(a, nearer);
      b = std::min(b, nearer);
    }
  }
  for (int& steps : distance) {
    if (steps == far || steps == 0) steps = kNever;
  }
  return distance;
}

int outside(int index, int first, int last) {
  return std::max(0, first - index) + std::max(0, index - last);
}

TEST(Layers, AreAtManhattanDistanceFromThePatch) {
  const TissueConfig config = withFixedBottom(blockOf(9, 8, 5));
  const Lattice lattice(config);
  const std::vector<int> patch = lattice.nodesIn(nodeBox(config, {3, 4, 5}, {5, 5, 5}));
  ASSERT_EQ(patch.size(), 6u);
  LayerWalk walk(lattice);
  walk.start(patch);
  const std::vector<int> layer_of = layersByWalk(walk, lattice, lattice.restState());
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const auto index = lattice.gridIndex(node);
    const int distance = outside(index[0], 3, 5) + outside(index[1], 4, 5) + 5 - index[2];
    const bool never = distance == 0 || lattice.isFixed(node);
    EXPECT_EQ(layer_of[at(node)], never ? kNever : distance);
  }
}

TEST(Layers, PassEveryFreeNodeOnce) {
  const Lattice lattice(withFixedBottom(blockOf(4, 4, 4)));
  LayerWalk walk(lattice);
  walk.start({lattice.node(2, 2, 4)});
  const std::vector<int> layer_of = layersByWalk(walk, lattice, lattice.restState());
  const auto never = std::count(layer_of.begin(), layer_of.end(), kNever);
  EXPECT_EQ(never, 25 + 1);  // fixed nodes and the seed
}

TEST(Layers, FixedNodesStopTheWalk) {
  TissueConfig config = blockOf(4, 2, 2);
  config.fixed.push_back(nodeBox(config, {2, 0, 0}, {2, 2, 2}));
  const Lattice lattice(config);
  LayerWalk walk(lattice);
  walk.start({lattice.node(0, 0, 0)});
  const std::vector<int> layer_of = layersByWalk(walk, lattice, lattice.restState());
  for (int node = 1; node < lattice.nodeCount(); ++node) {
    EXPECT_EQ(layer_of[at(node)] != kNever, lattice.gridIndex(node)[0] < 2);
  }
}

TEST(Layers, GoAroundACut) {
  const Lattice lattice(withFixedBottom(blockOf(6, 6, 4)));
  LatticeState state = lattice.restState();
  int cut = 0;
  for (std::size_t index = 0; index < lattice.springs().size(); ++index) {
    const Spring& spring = lattice.springs()[index];
    const auto node = lattice.gridIndex(spring.a);
    if (spring.axis != 0 || node[0] != 3 || node[2] < 2) continue;
    state.severed[index] = 1;
    ++cut;
  }
  ASSERT_EQ(cut, 21);
  const std::vector<int> seeds = {lattice.node(2, 3, 4)};
  LayerWalk walk(lattice);
  walk.start(seeds);
  const std::vector<int> layer_of = layersByWalk(walk, lattice, state);
  EXPECT_EQ(layer_of, distancesBySprings(lattice, state, seeds));
  // Straight through: 2 steps. Down below the cut, across, and up again: 8.
  EXPECT_EQ(layer_of[at(lattice.node(4, 3, 4))], 8);
}

TEST(Layers, EndWherePiecesPart) {
  const Lattice lattice(blockOf(3, 1, 1));
  LatticeState state = lattice.restState();
  for (std::size_t index = 0; index < lattice.springs().size(); ++index) {
    const Spring& spring = lattice.springs()[index];
    if (spring.axis == 0 && lattice.gridIndex(spring.a)[0] == 1) state.severed[index] = 1;
  }
  LayerWalk walk(lattice);
  walk.start({0});
  const std::vector<int> layer_of = layersByWalk(walk, lattice, state);
  for (int node = 1; node < lattice.nodeCount(); ++node) {
    EXPECT_EQ(layer_of[at(node)] != kNever, lattice.gridIndex(node)[0] < 2);
  }
}

TEST(Layers, AddedNodeComesWithTheNextLayerAndSpreadsFromThere) {
  const Lattice lattice(blockOf(10, 1, 1));
  const LatticeState state = lattice.restState();
  LayerWalk walk(lattice);
  walk.start({lattice.node(0, 0, 0)});
  const int far = lattice.node(10, 0, 0);
  walk.add(far);
  walk.add(far);
  walk.add(lattice.node(0, 0, 0));  // touched already
  const std::vector<int> layer_of = layersByWalk(walk, lattice, state);
  EXPECT_EQ(layer_of[at(far)], 1);
  EXPECT_EQ(layer_of[at(lattice.node(9, 0, 0))], 2);
  EXPECT_EQ(layer_of[at(lattice.node(1, 0, 0))], 1);
  EXPECT_EQ(layer_of[0], kNever);
}

TEST(Layers, StartForgetsTheWalkBefore) {
  const Lattice lattice(blockOf(5, 3, 2));
  const LatticeState state = lattice.restState();
  LayerWalk walk(lattice);
  walk.start({0});
  walk.next(state);
  walk.add(17);
  const std::vector<int> seeds = {lattice.node(5, 3, 2)};
  walk.start(seeds);
  EXPECT_EQ(layersByWalk(walk, lattice, state), distancesBySprings(lattice, state, seeds));
}

}  // namespace
}  // namespace robot_tissue::test_layers
