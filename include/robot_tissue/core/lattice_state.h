// Data between stages, 4 of 4: the shape.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A spring that is whole, where the surface along which a blade parted those beside it goes on: the
// blade ended before it.
struct SpringAhead {
  int spring = 0;
  double along = 0.5;     // where that surface passes, from the lower end, of the length (1)
  double distance = 0.0;  // from the blade's end to there, in spacings
};

struct LatticeState {
  std::vector<Vec3> displacement;     // per node, the ghosts last, from rest (m)
  std::vector<std::uint8_t> severed;  // per spring, 1 = cut
  int springs_cut = 0;
  // Per spring that is severed, how far along it from its lower end, of its length (1), material
  // was parted; 0: it was not, there is none left along the spring. Empty: half way along all.
  std::vector<double> parted_at;
  std::vector<SpringAhead> ahead;        // of the fronts of cuts, ascending
  std::shared_ptr<const CellSet> cells;  // what the cuts left of the lattice's
  int pieces = 1;                        // parts of the lattice that springs hold together
  // Per cell of the lattice, bit c: the eighth at its corner c was removed. Empty: nothing was.
  std::vector<std::uint8_t> taken;
  std::vector<double> left;  // per node of the lattice, of its share of the cells; empty: all
};

// Bits of the eighths of the lattice's cell that were removed.
inline unsigned takenOf(const LatticeState& state, int place) {
  return state.taken.empty() ? 0U : state.taken[at(place)];
}

inline bool isTaken(const LatticeState& state, int place, int corner) {
  return (takenOf(state, place) >> corner & 1U) != 0;
}

// As parted_at; 0 for a spring that is whole.
inline double partedAt(const LatticeState& state, int spring) {
  if (state.severed[at(spring)] == 0) return 0.0;
  return state.parted_at.empty() ? 0.5 : state.parted_at[at(spring)];
}

// Of a node of the lattice, 0 to 1.
inline double shareLeft(const LatticeState& state, int node) {
  return state.left.empty() ? 1.0 : state.left[at(node)];
}

// Nothing is left around the lattice's node.
inline bool isRemoved(const LatticeState& state, int node) { return shareLeft(state, node) == 0.0; }

// Nothing is left around the node, of the lattice or a ghost.
inline bool isGone(const LatticeState& state, int node) {
  return state.cells->isGhost(node) ? state.cells->meetings(node).isEmpty()
                                    : isRemoved(state, node);
}

// Nothing was cut or removed.
inline bool isAsMade(const LatticeState& state) {
  return state.springs_cut == 0 && state.taken.empty();
}

}  // namespace robot_tissue
