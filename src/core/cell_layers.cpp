#include "robot_tissue/core/cell_layers.h"

#include <algorithm>
#include <utility>

#include "robot_tissue/core/patch_motion.h"

namespace robot_tissue {

void CellLayers::start(std::shared_ptr<const CellSet> cells, const std::vector<std::uint8_t>& held,
                       const std::vector<int>& seeds, const std::vector<int>& first) {
  cells_ = std::move(cells);
  held_ = held;
  in_.assign(held.size(), 0);
  seen_.assign(held.size(), 0);
  cell_in_.assign(cells_->all().size(), 0);
  layers_.clear();
  next_.clear();
  touched_cells_.clear();
  count_ = 0;
  for (const int node : first) {
    if (held_[at(node)] == kAllHeld || seen_[at(node)] != 0) continue;
    seen_[at(node)] = 1;
    next_.push_back(node);
  }
  findNext(seeds);
  if (!next_.empty()) raise();
}

void CellLayers::raise(const std::vector<int>& nodes) {
  add(nodes);
  next_.erase(std::remove_if(next_.begin(), next_.end(), [&](int node) { return has(node); }),
              next_.end());
  findNext(nodes);
}

void CellLayers::add(std::vector<int> layer) {
  for (const int node : layer) {
    seen_[at(node)] = in_[at(node)] = 1;
    for (auto met = cells_->first(node); met != cells_->last(node); ++met) {
      std::uint8_t& in = cell_in_[at(met->cell)];
      if (in == 0) touched_cells_.push_back(met->cell);
      in = 1;
    }
  }
  count_ += static_cast<int>(layer.size());
  layers_.push_back(std::move(layer));
}

void CellLayers::findNext(const std::vector<int>& layer) {
  for (const int node : layer) {
    for (auto met = cells_->first(node); met != cells_->last(node); ++met) {
      for (const int other : cells_->all()[at(met->cell)].nodes) {
        if (seen_[at(other)] != 0 || held_[at(other)] == kAllHeld) continue;
        seen_[at(other)] = 1;
        next_.push_back(other);
      }
    }
  }
  std::sort(next_.begin(), next_.end());
}

}  // namespace robot_tissue
