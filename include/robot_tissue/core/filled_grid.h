// The grid of a tissue's nodes, and how much of each cell between them the tissue fills (own).
#pragma once

#include <utility>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct FilledGrid {
  Grid grid;  // with the cells that hold tissue, and their nodes
  // Share of each of the grid's cells, 0 = none. A cell that the surface of a mesh reaches into has
  // a thousandth at least, spread over the cell, so that the surface hangs on nodes.
  std::vector<double> filled;
  // Of the cells that are filled in part, in ascending order: where.
  std::vector<std::pair<int, CellFill>> partial;
};

// Throws InputError when a box's extent is no multiple of the spacing. The grid around a mesh must
// be in reach of int.
FilledGrid filledGrid(const TissueConfig& config);

}  // namespace robot_tissue
