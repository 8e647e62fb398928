// The cells between the nodes, that carry the material: 8 corners, 12 springs each. Corner c sits
// at the cell's lowest node plus (c & 1, c >> 1 & 1, c >> 2 & 1) spacings.
//
// A cut may split a cell (core/cutting/split_cells.h). Its parts are cells again, with 8 corners
// each; where a part lost a corner, a ghost stands in for the node (Molino, Bao, Fedkiw 2004, "A
// virtual node algorithm for changing mesh topology during simulation"). Ghosts are nodes that the
// lattice does not know: numbered from Lattice::nodeCount() on, with a displacement of their own,
// without springs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class Lattice;
struct LatticeState;

constexpr int kCorners = 8;

struct Cell {
  std::array<int, kCorners> nodes{};
  int place = 0;            // which of the lattice's cells it is, or is a part of
  std::uint8_t own = 0xff;  // bit c: corner c is its own; not set: a cut took it from this part
  std::shared_ptr<const CellFill> fill;  // what of that cell's volume h^3 it holds; null: all

  // What its share of the moduli is multiplied by (core/lattice/oblique_walls.h).
  double moduli_factor = 1.0;

  bool owns(int corner) const { return (own >> corner & 1) != 0; }
  bool isPart() const { return own != 0xff; }
  double share() const { return fill == nullptr ? 1.0 : fill->share; }  // of h^3, in (0, 1]
  // What the corner carries of it, in eighths of a full cell.
  double eighthsAt(int corner) const {
    return fill == nullptr ? 1.0 : kCorners * fill->share * fill->cornerShare(corner);
  }
};

// What becomes of cells that a cut has split: they go as a whole, or stay as parts with ghosts.
enum class SplitCells { kLost, kParted };

struct Ghost {
  int original = 0;    // the lattice's node at its grid point, that it stands in for
  bool fixed = false;  // the original is, and so is an own corner of a part that has the ghost:
                       // what a cut parts from all fixed nodes is free
};

// Cells, and who meets at a node. Constant after construction: a cut makes a new set.
class CellSet {
 public:
  // Where a node is met: cell (index into all()) and corner of it.
  struct Meeting {
    Meeting(int of_cell = 0, int of_corner = 0)
        : cell(static_cast<std::uint32_t>(of_cell) & 0x1fffffffU),
          corner(static_cast<std::uint32_t>(of_corner) & 7U) {}

    std::uint32_t cell : 29;
    std::uint32_t corner : 3;
  };

  CellSet() = default;
  // Cells in ascending order of their places, and how many nodes the lattice has.
  CellSet(std::vector<Cell> cells, int lattice_nodes, std::vector<Ghost> ghosts = {});

  const std::vector<Cell>& all() const { return cells_; }
  const std::vector<Ghost>& ghosts() const { return ghosts_; }
  // With the ghosts, which come after the lattice's.
  int nodeCount() const { return static_cast<int>(first_.size()) - 1; }
  int latticeNodeCount() const { return nodeCount() - static_cast<int>(ghosts_.size()); }
  bool isGhost(int node) const { return node >= latticeNodeCount(); }
  // The lattice's node at the same grid point: the node itself, or the ghost's original.
  int original(int node) const {
    return isGhost(node) ? ghosts_[at(node - latticeNodeCount())].original : node;
  }
  // The cell at the place that owns the corner; null where a cut left none.
  const Cell* owner(int place, int corner) const;
  // The cells that have the node as a corner, first .. last - 1; at most 8 that own it.
  const Meeting* first(int node) const { return meetings_.data() + first_[at(node)]; }
  const Meeting* last(int node) const { return meetings_.data() + first_[at(node) + 1]; }

 private:
  std::vector<Cell> cells_;
  std::vector<Ghost> ghosts_;
  std::vector<int> first_ = {0};  // per node, index into meetings_
  std::vector<Meeting> meetings_;
};

// Of any node, also of a ghost.
Vec3 restPosition(const Lattice& lattice, const CellSet& cells, int node);  // m
bool isFixed(const Lattice& lattice, const CellSet& cells, int node);

// Cells turned inside out: the mean deformation gradient's determinant is not positive.
int countInvertedCells(const Lattice& lattice, const LatticeState& state);
// Of those with a corner among the points.
int countInvertedCells(const Lattice& lattice, const LatticeState& state, const GridBox& points);

}  // namespace robot_tissue
