#include "solvers/paper/layers.h"

namespace robot_tissue {

LayerWalk::LayerWalk(const Lattice& lattice)
    : lattice_(lattice), touched_in_(static_cast<std::size_t>(lattice.nodeCount()), 0) {}

void LayerWalk::start(const std::vector<int>& seeds) {
  ++walk_;
  layer_.clear();
  upcoming_.clear();
  for (const int node : seeds) {
    if (touch(node)) layer_.push_back(node);
  }
}

void LayerWalk::add(int node) {
  if (touch(node)) upcoming_.push_back(node);
}

const std::vector<int>& LayerWalk::next(const LatticeState& state) {
  for (const int node : layer_) {
    for (int direction = 0; direction < kNeighbors; ++direction) {
      const int spring = lattice_.springOf(node, direction);
      if (spring < 0 || state.severed[static_cast<std::size_t>(spring)] != 0) continue;
      const int neighbor = lattice_.neighbor(node, direction);
      if (!lattice_.isFixed(neighbor)) add(neighbor);
    }
  }
  layer_.swap(upcoming_);
  upcoming_.clear();
  return layer_;
}

bool LayerWalk::touch(int node) {
  auto& touched_in = touched_in_[static_cast<std::size_t>(node)];
  if (touched_in == walk_) return false;
  touched_in = walk_;
  return true;
}

}  // namespace robot_tissue
