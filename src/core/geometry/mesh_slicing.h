// A mesh sliced by the grid of the nodes (own; the paper slices an object by such a grid without
// saying what becomes of cells that are filled in part).
//
// Every triangle is cut at the grid's planes. What lies under a piece, down to the floor of its
// cell, is a prism of known volume; the cells below it get the piece's whole shadow. The sum over
// the pieces, with the sign of their normal's z, is exact but for rounding (1e-10 of the volume),
// and so are the moments of what is filled:
// no ray can slip between triangles, thin walls are not missed, and the order of the triangles does
// not matter.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// Per cell of the grid, x running fastest.
struct MeshCells {
  // Share of the cell's volume inside the mesh, 0 to 1. The sum times the cell's volume is the
  // mesh's volume.
  std::vector<double> filled;
  // Of the cells that are filled in part, in ascending order: where the mesh is in them.
  std::vector<std::pair<int, FillIntegrals>> partial;
  // 1 = the surface reaches into the cell by more than a thousandth of the spacing, or more than
  // that share of the cell is filled. Every point of the mesh lies in such a cell, or nearer to one
  // than that slack along each axis; only what is itself thinner than twice the slack and lies
  // along a plane of nodes may have none.
  std::vector<std::uint8_t> occupied;
};

// Smallest grid of whole spacings that holds the mesh to a thousandth of the spacing. It is
// centered on the mesh's bounding box, so that a mesh moved by any offset is sliced the same, and a
// box of whole spacings is sliced at its faces. Its size must be in reach of int.
Grid gridAround(const TriangleMesh& mesh, double spacing);

// The mesh must pass meshFault, face outwards, and lie in the grid to a thousandth of its spacing.
MeshCells sliced(const TriangleMesh& mesh, const Grid& grid);

// The same of a mesh that may reach beyond the grid: what of it lies in the grid's cells.
MeshCells slicedWithin(const TriangleMesh& mesh, const Grid& grid);

}  // namespace robot_tissue
