// The parts of the lattice's cells, for surfaces along cuts.
#pragma once

#include <array>
#include <memory>
#include <set>
#include <vector>

#include "robot_tissue/core/carriers.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// What holds a point: the corners of a part of a cell that have a weight there.
struct Hold {
  std::array<NodeWeight, kCorners> carriers{};
  int count = 0;

  void add(int node, double weight) { carriers[at(count++)] = {node, weight}; }
  const NodeWeight* begin() const { return carriers.data(); }
  const NodeWeight* end() const { return carriers.data() + count; }
};

// With ghosts also for a model that has none (six_spring): there a ghost stands for the mean of the
// own corners nearest to it, over the parts that have it.
class CellParts {
 public:
  CellParts(const Lattice& lattice, const LatticeState& state);

  // It was split, or removed.
  bool isOpen(int place) const {
    const Cell* first = owner(place, 0);
    return first == nullptr || first->isPart();
  }
  // The part that has the eighth at the corner; null where it was removed.
  const Cell* owner(int place, int corner) const {
    const int part = ownerAt(place, corner);
    return part < 0 ? nullptr : &cells_->all()[at(part)];
  }
  // Its number, -1: none.
  int ownerAt(int place, int corner) const {
    for (int part = first_at_[at(place)]; part < first_at_[at(place) + 1]; ++part) {
      if (cells_->all()[at(part)].owns(corner)) return part;
    }
    return -1;
  }
  std::size_t count() const { return cells_->all().size(); }

  // Without ghosts where the model has none.
  void addCarriers(const CarrierRange& carriers, CarrierLists& to) const;
  const CellSet& cells() const { return *cells_; }

 private:
  bool hasAll(const Lattice& lattice, const LatticeState& state) const;
  void replaceGhosts();
  void findFirst(std::size_t places);

  struct StandIn {
    int distance = kCorners;  // in springs
    std::set<int> nodes;
  };

  std::shared_ptr<const CellSet> cells_;
  std::vector<int> first_at_;       // per place, the first of its cells; then how many there are
  std::vector<StandIn> stand_ins_;  // per ghost; empty: ghosts move by themselves
};

}  // namespace robot_tissue
