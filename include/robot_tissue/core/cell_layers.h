// Layers of nodes around loading patches (paper, section 4.2), by cells: layer n + 1 is every node
// that shares a cell with layer n. The forces of a model with cells reach along diagonals, where
// springs do not (LayerWalk).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"

namespace robot_tissue {

class CellLayers {
 public:
  // `seeds` are around which the layers lie, `first` are in the first of them; nodes that may not
  // move at all (kAllHeld) are in none.
  void start(std::shared_ptr<const CellSet> cells, const std::vector<std::uint8_t>& held,
             const std::vector<int>& seeds, const std::vector<int>& first);

  // What would be the next layer, ascending; empty when there is none.
  const std::vector<int>& next() const { return next_; }
  // Makes it one. If some of it is to stay out, `nodes` is what gets in.
  void raise() { raise(std::vector<int>(next_)); }
  void raise(const std::vector<int>& nodes);

  const std::vector<std::vector<int>>& all() const { return layers_; }
  bool has(int node) const { return in_[static_cast<std::size_t>(node)] != 0; }
  int nodeCount() const { return count_; }
  // Cells that a node of a layer is a corner of, ascending within each layer's share.
  const std::vector<int>& cells() const { return touched_cells_; }

 private:
  void add(std::vector<int> layer);
  void findNext(const std::vector<int>& layer);

  std::shared_ptr<const CellSet> cells_;
  std::vector<std::uint8_t> held_;
  std::vector<std::uint8_t> in_;    // per node: in a layer
  std::vector<std::uint8_t> seen_;  // per node: in a layer, a seed, or in next_
  std::vector<std::uint8_t> cell_in_;
  std::vector<std::vector<int>> layers_;
  std::vector<int> next_;
  std::vector<int> touched_cells_;
  int count_ = 0;
};

}  // namespace robot_tissue
