// Where springs are parted, kept of those alone that are severed: a few of a lattice's.
#pragma once

#include <vector>

#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

inline std::vector<double> partingsOf(const LatticeState& state) {
  std::vector<double> partings;
  if (state.parted_at.empty()) return partings;
  for (std::size_t spring = 0; spring < state.severed.size(); ++spring) {
    if (state.severed[spring] != 0) partings.push_back(state.parted_at[spring]);
  }
  return partings;
}

// Of the springs that are severed in the state, in ascending order; none: it is not known.
inline void takePartings(const std::vector<double>& partings, LatticeState& state) {
  if (partings.empty()) return;
  state.parted_at.assign(state.severed.size(), 0.5);
  auto next = partings.begin();
  for (std::size_t spring = 0; spring < state.severed.size(); ++spring) {
    if (state.severed[spring] != 0) state.parted_at[spring] = *next++;
  }
}

}  // namespace robot_tissue
