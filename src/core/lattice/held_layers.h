// Layers of a mesh between its surface and the lattice's nodes, which nodes outside of it hold
// (own; doc/model.md, "Shapes by a mesh").
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Of a cell filled in part, where nodes are held on a side that its material does not reach.
struct HeldLayer {
  int side = 0;            // number 2 a is down axis a, 2 a + 1 up
  double thickness = 1.0;  // from the nodes across to where the material ends, of the spacing
};

// From the cell's side to where its material begins, of the spacing; a layer is no thinner than a
// least thickness.
double gapAt(const CellFill& fill, int side);

// Of the sides that are held, the one that is farthest from the material. Nothing: there is none,
// the one across is held, too, or the material reaches it.
std::optional<HeldLayer> heldLayer(const Cell& cell, const std::function<bool(int side)>& is_held);

// Held are nodes outside of the surface, meant is the surface itself. As a share t of its cell,
// with the strain along that, a layer would have t of a full cell's stiffness across itself; it has
// 1 / t. So its fill is moved to the fixed nodes, where strains along the surface are t of those
// in the cell, too, and is 1 / t^2 times as firm: at small strains that is the layer's own energy.
void layOnFixedNodes(std::vector<Cell>& cells, const std::vector<std::uint8_t>& fixed);

// Where the mesh has it.
CellFill fillInMesh(const CellFill& fill);

// Of what a cut leaves of such a cell, where the mesh has it: laid on the fixed nodes, too, if the
// part has such nodes of its own; else material where it is.
CellFill partOfLayer(const Cell& whole, const Cell& part, const CellFill& fill);

}  // namespace robot_tissue
