// A grid of half spacings whose planes between nodes are bent (own).
//
// In each cell its points -- of edges, faces, the inside -- stand elsewhere than half way, and
// between them it is linear in tetrahedra from a node over an edge's and a face's point to that
// inside: six around each of the cell's corners. Planes of nodes stay as they are.
#pragma once

#include <array>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Of an octant or of a point of the grid: indices along x, y, z in half spacings.
using HalfIndex = std::array<int, 3>;

// Lengths in spacings, from the grid's lowest corner.
class BentGrid {
 public:
  virtual ~BentGrid() = default;
  // Straight coordinates of a place: where it would be if the grid were straight. Continuous over
  // the cells that there are, and one to one within each.
  virtual Vec3 straightened(const Vec3& place) const = 0;
  // Of a point of the half grid.
  virtual Vec3 placeOf(const HalfIndex& point) const = 0;
  // Whether any point of the cell stands elsewhere than half way. `octant`: any of the cell's.
  virtual bool isBent(const HalfIndex& octant) const = 0;
};

}  // namespace robot_tissue
