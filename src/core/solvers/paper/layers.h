// Layers of nodes around seeds, found one at a time (paper, section 4.2 and figure 2): layer n + 1
// is every untouched node that an uncut spring joins to layer n.
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

class LayerWalk {
 public:
  explicit LayerWalk(const Lattice& lattice);

  // Layer 0: the loading area.
  void start(const std::vector<int>& seeds);
  // Adds a node to the next layer, unless it was touched before.
  void add(int node);
  // The next layer outwards; empty when nothing is left to touch. Fixed nodes belong to no layer.
  const std::vector<int>& next(const LatticeState& state);

 private:
  bool touch(int node);

  const Lattice& lattice_;
  std::vector<std::uint32_t> touched_in_;  // per node: the walk that touched it last
  std::uint32_t walk_ = 0;
  std::vector<int> layer_;
  std::vector<int> upcoming_;
};

}  // namespace robot_tissue
