// How a point in a cell moves with the material (own).
//
// Between a cell's corners displacements go straight; a surface that tools dent does not, and a
// point half way between two nodes then lags behind by q / 8, where q is their second difference:
// tools that press on such points dent a coarse lattice too far. So a point has, along each axis,
//
//   u = sum of N_i u_i + x (x - 1) / 2 q       x: 0 to 1 across the cell
//
// with q, along each edge of the cell, from the nodes next to its ends: as exact as trilinear
// weights for a linear shape, and exact for a quadratic one, too. Between two whole neighbors that
// is the cubic of Catmull and Rom (1974). What is next to an edge depends on the edge alone, so
// that the shape goes on without a step from cell to cell, however they are filled.
#pragma once

#include <vector>

#include "robot_tissue/core/cells.h"
#include "surface/cell_parts.h"

namespace robot_tissue {

// `place`: 0 to 1 along each axis of the cell. Corners without weight are left out.
Hold trilinearCarriers(const Cell& cell, const Vec3& place);

// The same with q; weights sum to 1, nodes ascending, some of them below zero. A node's q
// counts by how much is filled there: the nodes of a sliver, which next to nothing holds, would
// else be flung out by what presses the point.
std::vector<NodeWeight> smoothCarriers(const CellSet& cells, const Cell& cell, const Vec3& place);

}  // namespace robot_tissue
