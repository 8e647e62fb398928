// Where a level of a block is cut (own): the cells in a box, each by itself, in the place of those
// that the block has there; from it to the next coarser level, what cuts leave of P. Cells along
// the box's sides are whole, and their nodes the grid's, so that beyond it all is as in a block.
#pragma once

#include <array>
#include <vector>

#include "material/elastic_model.h"
#include "robot_tissue/core/grid_box.h"
#include "solvers/multigrid/level/lattice_coarsening.h"

namespace robot_tissue {

constexpr GridBox kNowhere = {{1, 1, 1}, {0, 0, 0}};

struct ListedCells {
  GridBox box = kNowhere;  // points of the level's whole grid; even where it has a next coarser one
  LevelGrid grid;          // the whole one
  int beside = 0;          // nodes beside it, all at points in the box
  std::vector<LevelCell> cells;  // that have their lowest corner in the box, and are not beyond it
  Coarsening to_coarser;         // of the box, without its cells

  bool isEmpty() const { return box.isEmpty(); }
};

// Of the cells between the points, by the lowest corner.
inline bool hasCell(const GridBox& points, const std::array<int, 3>& place) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (place[axis] < points.low[axis] || place[axis] >= points.high[axis]) return false;
  }
  return true;
}

// The same by other numbers of the nodes, without neighbors of which a node has none (-1).
template <typename EntryOf>
SharedConst<CellReach> reachAt(const SharedConst<CellReach>& reach, EntryOf entry_of) {
  if (reach == nullptr) return {};
  CellReach renumbered = *reach;
  for (std::size_t i = 0; i < kBeyond; ++i) {
    int& node = renumbered.nodes[i];
    if (node >= 0) node = entry_of(node);
    if (node < 0) renumbered.share[i / kFaceNodes] = 0.0;
  }
  return SharedConst<CellReach>(renumbered);
}

// A cell of the finest level; `entry_of` a node: its entry there. Moduli in `modulus` (Pa).
template <typename EntryOf>
LevelCell levelCellOf(const ElasticModel& model, const Cell& cell, double modulus,
                      const std::array<int, 3>& place, EntryOf entry_of) {
  LevelCell level_cell;
  level_cell.place = place;
  const Moduli moduli = model.cellModuli(cell);
  level_cell.shear = moduli.shear / modulus;
  level_cell.bulk = moduli.bulk / modulus;
  level_cell.stiffening = moduli.stiffening;
  if (cell.fill != nullptr) {
    level_cell.fill =
        levelFill(*cell.fill, level_cell.shear / cell.share(), level_cell.bulk / cell.share());
  }
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    level_cell.nodes[corner] = entry_of(cell.nodes[corner]);
  }
  level_cell.reach = reachAt(cell.reach, entry_of);
  return level_cell;
}

// The least box of even points, or that ends with the grid, with this one and so many more.
GridBox evenAround(const GridBox& box, int layers, const GridBox& whole);

// A part of a level's whole grid: entries there, for those of the whole.
class PartEntries {
 public:
  // The part's grid has these points of the whole one, and all nodes beside it.
  PartEntries(const LevelGrid& whole, const GridBox& points, const LevelGrid& part)
      : whole_(whole), low_(points.low), part_(part) {}

  int operator()(int entry) const {
    if (entry >= whole_.beside) return part_.beside + entry - whole_.beside;
    const std::array<int, 3> place = whole_.placeOf(entry);
    return part_.index(place[0] - low_[0], place[1] - low_[1], place[2] - low_[2]);
  }
  LevelCell operator()(LevelCell cell) const {
    for (std::size_t axis = 0; axis < 3; ++axis) cell.place[axis] -= low_[axis];
    for (int& node : cell.nodes) node = (*this)(node);
    cell.reach = reachAt(cell.reach, [this](int node) { return has(node) ? (*this)(node) : -1; });
    return cell;
  }
  NodeShares operator()(NodeShares shares) const {
    for (NodeWeight& share : shares) share.node = (*this)(share.node);
    return shares;
  }

 private:
  bool has(int entry) const {
    if (entry >= whole_.beside) return true;
    const std::array<int, 3> place = whole_.placeOf(entry);
    bool in_part = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      in_part = in_part && place[axis] >= low_[axis] && place[axis] - low_[axis] < part_.size[axis];
    }
    return in_part;
  }

  const LevelGrid& whole_;
  std::array<int, 3> low_;
  const LevelGrid& part_;
};

}  // namespace robot_tissue
