#include "lattice/connectivity.h"

#include <vector>

namespace robot_tissue {

int countPieces(const Lattice& lattice, const LatticeState& state) {
  std::vector<char> reached(at(lattice.nodeCount()), 0);
  std::vector<int> pending;
  int pieces = 0;
  for (int start = 0; start < lattice.nodeCount(); ++start) {
    if (reached[at(start)] != 0) continue;
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

}  // namespace robot_tissue
