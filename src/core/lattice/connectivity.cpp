#include "lattice/connectivity.h"

#include <algorithm>
#include <vector>

#include "robot_tissue/core/disjoint_sets.h"
#include "robot_tissue/core/grid_box.h"

namespace robot_tissue {

int countPieces(const Lattice& lattice, const LatticeState& state) {
  std::vector<char> reached(at(lattice.nodeCount()), 0);
  std::vector<int> pending;
  int pieces = 0;
  for (int start = 0; start < lattice.nodeCount(); ++start) {
    if (reached[at(start)] != 0 || isRemoved(state, start)) continue;
    ++pieces;
    reached[at(start)] = 1;
    pending.assign(1, start);
    while (!pending.empty()) {
      const int node = pending.back();
      pending.pop_back();
      for (int direction = 0; direction < kNeighbors; ++direction) {
        const int spring = lattice.springOf(node, direction);
        if (spring < 0 || state.severed[at(spring)] != 0) continue;
        const int other = lattice.neighbor(node, direction);
        if (reached[at(other)] != 0) continue;
        reached[at(other)] = 1;
        pending.push_back(other);
      }
    }
  }
  return pieces;
}

namespace {

// Spacings (1): so far around springs it is looked for another way between their ends. More: slower
// where pieces come apart; less: ways around longer cuts are not seen. Chosen.
constexpr int kAround = 2;

GridBox around(const Lattice& lattice, const std::vector<int>& springs) {
  GridBox box = {{1, 1, 1}, {0, 0, 0}};
  for (const int spring : springs) {
    const Spring ends = lattice.springs()[at(spring)];
    box = joined(box, {lattice.gridIndex(ends.a), lattice.gridIndex(ends.b)});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::max(0, box.low[axis] - kAround);
    box.high[axis] = std::min(lattice.size()[axis] - 1, box.high[axis] + kAround);
  }
  return box;
}

}  // namespace

bool holdTogether(const Lattice& lattice, const LatticeState& state,
                  const std::vector<int>& severed) {
  if (severed.empty()) return true;
  const GridBox box = around(lattice, severed);
  const int row = box.high[0] - box.low[0] + 1, plane = row * (box.high[1] - box.low[1] + 1);
  const auto number = [&](const std::array<int, 3>& place) {
    return place[0] - box.low[0] + row * (place[1] - box.low[1]) + plane * (place[2] - box.low[2]);
  };
  DisjointSets together(at(plane * (box.high[2] - box.low[2] + 1)));
  for (int k = box.low[2]; k <= box.high[2]; ++k) {
    for (int j = box.low[1]; j <= box.high[1]; ++j) {
      for (int i = box.low[0]; i <= box.high[0]; ++i) {
        const int node = lattice.node(i, j, k);
        for (int axis = 0; node >= 0 && axis < 3; ++axis) {
          const int spring = lattice.springOf(node, 2 * axis + 1);
          std::array<int, 3> upper = {i, j, k};
          ++upper[at(axis)];
          if (spring < 0 || state.severed[at(spring)] != 0 || !box.has(upper)) continue;
          together.join(number({i, j, k}), number(upper));
        }
      }
    }
  }
  return std::all_of(severed.begin(), severed.end(), [&](int spring) {
    const Spring ends = lattice.springs()[at(spring)];
    return together.lowest(number(lattice.gridIndex(ends.a))) ==
           together.lowest(number(lattice.gridIndex(ends.b)));
  });
}

std::vector<int> pieceOfNodes(const Lattice& lattice, const LatticeState& state) {
  const CellSet& cells = *state.cells;
  DisjointSets nodes(at(cells.nodeCount()));
  for (const Spring ends : lattice.springs()) {
    if (state.severed[at(ends.number)] == 0) nodes.join(ends.a, ends.b);
  }
  for (const Cell& part : cells.all()) {
    if (!part.isPart() || part.own == 0) continue;
    const int own = part.lowestOwn();
    for (const int node : part.nodes) {
      if (cells.isGhost(node)) nodes.join(part.nodes[at(own)], node);
    }
  }
  std::vector<int> piece(at(cells.nodeCount()), -1);
  int pieces = 0;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    if (isGone(state, node)) continue;
    const int lowest = nodes.lowest(node);
    // Ghosts come last: one that is joined to no node is of a part that lost its nodes.
    if (cells.isGhost(lowest)) continue;
    piece[at(node)] = lowest == node ? pieces++ : piece[at(lowest)];
  }
  return piece;
}

}  // namespace robot_tissue
