// The cells between the nodes, that carry the material: 8 corners, 12 springs each. Corner c sits
// at the cell's lowest node plus (c & 1, c >> 1 & 1, c >> 2 & 1) spacings.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class Lattice;
struct LatticeState;

constexpr int kCorners = 8;

struct Cell {
  std::array<int, kCorners> nodes{};
  int place = 0;       // which of the lattice's cells it is, or is a part of
  double share = 1.0;  // of that cell's volume h^3 that it holds, in (0, 1]
};

// Cells, and who meets at a node. Constant after construction: a cut makes a new set.
class CellSet {
 public:
  // Where a node is met: cell (index into all()) and corner of it.
  struct Meeting {
    int cell = 0;
    int corner = 0;
  };

  CellSet() = default;
  CellSet(std::vector<Cell> cells, int nodes);

  const std::vector<Cell>& all() const { return cells_; }
  int nodeCount() const { return static_cast<int>(first_.size()) - 1; }
  // The cells that have the node as a corner, first .. last - 1; at most 8.
  const Meeting* first(int node) const { return meetings_.data() + first_[at(node)]; }
  const Meeting* last(int node) const { return meetings_.data() + first_[at(node) + 1]; }
  // No cell has the node as a corner: nothing holds it.
  bool isLoose(int node) const { return first(node) == last(node); }

 private:
  std::vector<Cell> cells_;
  std::vector<int> first_ = {0};  // per node, index into meetings_
  std::vector<Meeting> meetings_;
};

// For each corner the lowest corner of the part of the cell it belongs to; corners that uncut
// springs of the cell join are in one part. All zero in a whole cell.
std::array<int, kCorners> cellParts(const Lattice& lattice, const LatticeState& state,
                                    const std::array<int, kCorners>& corners);

// What the severed springs leave of the lattice's cells: the whole ones. A cell that is split, that
// is, whose corners uncut springs no longer hold together, is lost.
std::shared_ptr<const CellSet> cellsLeft(const Lattice& lattice, const LatticeState& state);

// Cells turned inside out: the mean deformation gradient's determinant is not positive.
int countInvertedCells(const Lattice& lattice, const LatticeState& state);

}  // namespace robot_tissue
