// What the parts of a lattice are called, through all cuts and removals (own).
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// The cell's share (Cell::share), so that parts of one size are equal.
std::int64_t millionthsOf(const Cell& cell);

// A part that comes apart leaves its number to the largest of what it leaves, by volume at rest, of
// equal ones to that with the lowest node; the others get the next numbers, in the order of their
// lowest nodes. No number is given twice.
class PieceNumbers {
 public:
  // Of each part, in the order of the parts' lowest nodes (lattice/connectivity.h).
  struct Names {
    std::vector<int> of_parts;
    int next = 0;              // number of the next new part
    std::vector<int> dropped;  // of parts that were taken out as nothing held them, in that order

    // 0, 1, ... without a gap, as of a lattice that was never cut.
    bool areCounted() const;
  };
  static Names counted(int parts);

  PieceNumbers(const Lattice& lattice, const LatticeState& state)
      : PieceNumbers(lattice, state, counted(state.pieces)) {}
  PieceNumbers(const Lattice& lattice, const LatticeState& state, Names names);

  const Names& names() const { return names_; }
  std::size_t bytes() const { return of_nodes_.size() * sizeof(int); }  // nearly all of it
  // After cuts and removals: parts may have come apart, or have gone.
  PieceNumbers after(const Lattice& lattice, const LatticeState& state) const;
  // With these among the dropped ones.
  PieceNumbers without(const std::vector<int>& dropped) const;

 private:
  // `parts`: of each node, as pieceOfNodes has them.
  PieceNumbers(const Lattice& lattice, Names names, std::vector<int> parts);

  int numberAt(std::size_t node) const {
    return of_nodes_.empty() ? names_.of_parts.front() : of_nodes_[node];
  }

  Names names_;
  std::vector<int> of_nodes_;  // of the lattice's nodes; of removed ones: any; empty: of one part
};

}  // namespace robot_tissue
