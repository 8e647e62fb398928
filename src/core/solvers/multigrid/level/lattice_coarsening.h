// From a lattice to one of twice its spacing (own). Of the eight cells at a coarse cell's place,
// those that share nodes, directly or through others of the eight, become one coarse cell; what a
// cut has parted there becomes several, at the same place. Two coarse cells share a coarse node
// where cells of theirs share a fine one: what a cut parts stays parted on every level.
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/types.h"
#include "solvers/multigrid/level/level_cell.h"

namespace robot_tissue {

// Entries of a level's fields: the grid's points, x fastest; planes are padded, so that the lanes
// of a vector that reach beyond a plane's last cell write to no node. Then the nodes beside the
// grid: those at a point whose entry another node has (where a cut has parted cells).
struct LevelGrid {
  std::array<int, 3> size{};
  int row = 0;
  int plane = 0;
  int beside = 0;  // first entry of those beside the grid

  LevelGrid() = default;
  explicit LevelGrid(const std::array<int, 3>& points);
  int index(int i, int j, int k) const { return i + row * j + plane * k; }
  GridBox whole() const { return wholeOf(size); }
  std::array<int, 3> placeOf(int entry) const {
    return {entry % plane % row, entry % plane / row, entry / plane};
  }
};

using NodeShares = std::vector<NodeWeight>;  // weights sum to 1

struct Coarsening {
  LevelGrid grid;
  int nodes_beside = 0;
  std::vector<LevelCell> cells;
  // Fine nodes whose carriers in P are not the coarse grid points around them, but these;
  // ascending.
  struct Carried {
    int node = 0;
    NodeShares carriers;
  };
  std::vector<Carried> carried;
  // Coarse nodes that do not start where the fine grid point at their place is, but at the mean of
  // these fine nodes.
  struct Start {
    int node = 0;
    NodeShares fine;
  };
  std::vector<Start> starts;
};

Coarsening coarsened(const LevelGrid& fine, const std::vector<LevelCell>& cells, int entries);

// The coarse grid points around a fine place, with their weights.
NodeShares sharesAround(const LevelGrid& coarse, const std::array<int, 3>& fine_place);

}  // namespace robot_tissue
