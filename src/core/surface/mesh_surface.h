// The displayed surface of a tissue that a mesh gives (own): the mesh itself, which the cells
// carry.
//
// A vertex moves as the material around it (smoothCarriers), by the corners of the cell it is in
// and of the cells beside that.
#pragma once

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "surface/cell_parts.h"

namespace robot_tissue {

// The cell that holds the point at rest, or the nearest one; of several the fullest. `point`: in
// spacings from the grid's lowest corner, in the grid to a few thousandths.
int cellAround(const Lattice& lattice, const Vec3& point);
// The same, -1 where there is none next to it.
int nearestCell(const Lattice& lattice, const Vec3& point);

// Where a point as above is in the cell, or nearest to it there: 0 to 1 along each axis.
Vec3 placeIn(const Lattice& lattice, const Cell& cell, const Vec3& point);

// `mesh`: closed, of which the lattice was made, with edges of a spacing at most.
//
// Cuts open it where the blade passed: around a split cell the mesh is cut into octants
// (mesh_pieces.h), whose sides stand where the blade parted the cell (divided_grid.h), every octant
// moves with the part of the cell that owns its corner, and between octants that part with each
// other lids close both sides. Closed by construction: a lid is left out only where both sides hang
// on the same nodes. Of the skin's pieces those stay that wounds ask for (merged_skin.h).
TissueSurface meshSurface(const Lattice& lattice, const LatticeState& state,
                          const TriangleMesh& mesh);

}  // namespace robot_tissue
