// Slivers: cells that hold little beside one that holds much (own).
#pragma once

#include <memory>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// A full cell lends its spread to cells beside it that are filled in part, those with a node in
// common (CellFill::lent). It is itself too soft against bending, and they make up for that
// (material/fill_law.h); the nodes of a sliver that no other cell has would also be all but loose
// otherwise. A wall without full cells stays as thin as it is. Nodes are below `node_count`.
void stiffenSlivers(std::vector<Cell>& cells, int node_count);

// A fill as it was before that.
SharedConst<CellFill> unraised(const SharedConst<CellFill>& fill);

}  // namespace robot_tissue
