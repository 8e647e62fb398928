// Slivers: cells that hold little beside one that holds much (own).
#pragma once

#include <memory>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Raises the spread of cells that are filled in part. One beside a full cell, with a node in
// common, bends no more easily than that; a thinner cell of spread l lends 12 l^2, and what holds
// less than the sliver as much less. The nodes of a sliver that no other cell has would otherwise
// be all but loose against bending, and relaxation takes ten times the cycles. A wall by itself
// stays nearly as thin as it is. Nodes are below `node_count`.
void stiffenSlivers(std::vector<Cell>& cells, int node_count);

// A fill as it was before that.
std::shared_ptr<const CellFill> unraised(const std::shared_ptr<const CellFill>& fill);

}  // namespace robot_tissue
