#include "lattice/connectivity.h"

#include <vector>

#include "robot_tissue/core/disjoint_sets.h"

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

std::vector<int> pieceOfNodes(const Lattice& lattice, const LatticeState& state) {
  const CellSet& cells = *state.cells;
  DisjointSets nodes(at(cells.nodeCount()));
  for (std::size_t spring = 0; spring < lattice.springs().size(); ++spring) {
    const Spring& ends = lattice.springs()[spring];
    if (state.severed[spring] == 0) nodes.join(ends.a, ends.b);
  }
  for (const Cell& part : cells.all()) {
    if (!part.isPart() || part.own == 0) continue;
    int own = 0;
    while (!part.owns(own)) ++own;
    for (const int node : part.nodes) {
      if (cells.isGhost(node)) nodes.join(part.nodes[at(own)], node);
    }
  }
  std::vector<int> piece(at(cells.nodeCount()), -1);
  int pieces = 0;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    if (!cells.isGhost(node) && isRemoved(state, node)) continue;
    const int lowest = nodes.lowest(node);
    piece[at(node)] = lowest == node ? pieces++ : piece[at(lowest)];
  }
  return piece;
}

}  // namespace robot_tissue
