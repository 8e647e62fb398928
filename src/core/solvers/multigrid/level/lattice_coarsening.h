// From a lattice to one of twice its spacing (own). A coarse cell stands for the cells in it that
// hang together; cells that a cut has parted become coarse cells of their own, at the same place.
// Coarse cells have nodes in common where their cells have some: so what a cut parts stays parted,
// on every level, and a piece that hangs on nothing has no node in common with the rest.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/grid_box.h"

namespace robot_tissue {

// A cell of a level: its lowest grid point, its corners' entries in the level's fields, moduli.
struct LevelCell {
  std::array<int, 3> place{};
  std::array<int, kCorners> nodes{};
  double shear = 0.0;
  double bulk = 0.0;
};

// Entries of a level's fields: the grid's points, x fastest, planes padded so that what a block of
// cells touches beyond its plane's corners is nobody's; then nodes beside it,
// that stand where a grid point is taken.
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

struct NodeShare {
  int node = 0;
  double weight = 0.0;
};
using NodeShares = std::vector<NodeShare>;  // weights sum to 1

struct Coarsening {
  LevelGrid grid;
  int nodes_beside = 0;
  std::vector<LevelCell> cells;
  // Fine nodes that are not the mean of the coarse grid points around them, but of these.
  std::unordered_map<int, NodeShares> carriers;
  std::vector<int> carried;  // which, in ascending order
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
