#include "surface/cell_parts.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "cutting/split_cells.h"

namespace robot_tissue {

CellParts::CellParts(const Lattice& lattice, const LatticeState& state) : cells_(state.cells) {
  const bool has_all = hasAll(lattice, state);
  if (!has_all) cells_ = cellsLeft(lattice, state, SplitCells::kParted);
  findFirst(lattice.cells().size());
  if (!has_all) replaceGhosts();
}

void CellParts::findFirst(std::size_t places) {
  first_at_.assign(places + 1, 0);
  for (const Cell& cell : cells_->all()) ++first_at_[at(cell.place) + 1];
  std::partial_sum(first_at_.begin(), first_at_.end(), first_at_.begin());
}

void CellParts::addCarriers(const CarrierRange& carriers, CarrierLists& to) const {
  if (stand_ins_.empty()) return to.push_back(carriers);
  std::map<int, double> weights;
  for (const NodeWeight& carrier : carriers) {
    if (!cells_->isGhost(carrier.node)) {
      weights[carrier.node] += carrier.weight;
      continue;
    }
    const auto& nodes = stand_ins_[at(carrier.node - cells_->latticeNodeCount())].nodes;
    for (const int node : nodes) {
      weights[node] += carrier.weight / static_cast<double>(nodes.size());
    }
  }
  std::vector<NodeWeight> own;
  for (const auto& [node, weight] : weights) own.push_back({node, weight});
  to.push_back(own);
}

bool CellParts::hasAll(const Lattice& lattice, const LatticeState& state) const {
  std::vector<unsigned> known(lattice.cells().size(), 0);
  for (std::size_t place = 0; place < known.size(); ++place) {
    known[place] = takenOf(state, static_cast<int>(place));
  }
  for (const Cell& cell : cells_->all()) known[at(cell.place)] |= cell.own;
  return std::all_of(known.begin(), known.end(), [](unsigned bits) { return bits == 0xff; });
}

void CellParts::replaceGhosts() {
  stand_ins_.resize(cells_->ghosts().size());
  for (const Cell& cell : cells_->all()) {
    for (int lost = 0; lost < kCorners; ++lost) {
      if (!cells_->isGhost(cell.nodes[at(lost)])) continue;
      StandIn& ghost = stand_ins_[at(cell.nodes[at(lost)] - cells_->latticeNodeCount())];
      for (int corner = 0; corner < kCorners; ++corner) {
        if (!cell.owns(corner)) continue;
        const int apart = corner ^ lost;
        const int distance = (apart & 1) + (apart >> 1 & 1) + (apart >> 2 & 1);
        if (distance < ghost.distance) ghost = {distance, {}};
        if (distance == ghost.distance) ghost.nodes.insert(cell.nodes[at(corner)]);
      }
    }
  }
}

}  // namespace robot_tissue
