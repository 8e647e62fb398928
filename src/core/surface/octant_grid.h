// The eighths of the lattice's cells, each around one corner, and what holds their points (own).
//
// A point of the half grid has indices in half spacings: even ones at nodes. Where a blade parted
// cells it stands where that passed (cutting/cell_division.h), so that the sides of eighths along a
// cut lie on the blade. What a part of a cell has of it moves as the material there: with trilinear
// weights on the part's corners, ghosts where it lost them.
#pragma once

#include <array>
#include <vector>

#include "cutting/cell_division.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "surface/cell_parts.h"

namespace robot_tissue {

using HalfPoint = std::array<int, 3>;

// What a face shows: the tissue's skin, or what a cut or a removal opened.
enum class Face { kOuter, kOpened };

struct Octant {
  int cell = -1;  // of the lattice; -1: none
  int corner = 0;

  bool operator==(const Octant& other) const {
    return cell == other.cell && corner == other.corner;
  }
};

bool holdTheSame(const Hold& a, const Hold& b);  // the same nodes

class OctantGrid {
 public:
  OctantGrid(const Lattice& lattice, const LatticeState& state);

  // As Lattice::cellAt, for points from -1 to one beyond the lattice's last.
  int cellAt(const std::array<int, 3>& index) const {
    return cell_at_[at(index[0] + 1 + row_ * (index[1] + 1) + plane_ * (index[2] + 1))];
  }
  // The cell was split, or removed, at least in part.
  bool isOpen(int cell) const { return open_[at(cell)] != 0; }
  bool isThere(const Octant& octant) const {
    return octant.cell >= 0 && !isTaken(state_, octant.cell, octant.corner);
  }
  int nodeOf(const Octant& octant) const;
  // Number of the part that has the octant, of as many as there are.
  int partOf(const Octant& octant) const { return parts_.ownerAt(octant.cell, octant.corner); }
  std::size_t partCount() const { return parts_.count(); }
  HalfPoint lowestOf(const Octant& octant) const;
  CellPoint inCell(int cell, const HalfPoint& point) const;
  Octant octantAt(const HalfPoint& lowest) const;
  // Across the side of the octant: 2 * axis, + 1 the upper one.
  Octant beyond(const Octant& octant, int side) const;

  // What holds the point, which is of the octant. Nodes ascending, ghosts for nodes that are lost.
  Hold holdOf(const Octant& octant, const HalfPoint& point) const;
  // Without ghosts where the model has none.
  void addCarriers(const Hold& hold, CarrierLists& to) const {
    parts_.addCarriers({hold.begin(), hold.end()}, to);
  }
  // Material is on both sides of the side, and the same nodes hold it there.
  bool isJoined(const Octant& octant, int side) const;
  Vec3 placeOf(const Octant& octant, const HalfPoint& point) const;  // at rest (m)

 private:
  void placeCells();
  Vec3 placeInCell(const Octant& octant, const HalfPoint& point) const;
  int cornerAt(const Octant& octant, const HalfPoint& node) const;

  const Lattice& lattice_;
  const LatticeState& state_;
  CellParts parts_;
  std::vector<char> open_;    // per cell
  std::vector<int> cell_at_;  // per lowest corner's grid point, with one more on all sides
  int row_ = 0, plane_ = 0;   // of these
  CellDivisions divisions_;
};

// Corners of an octant's or a cell's side, counter-clockwise seen from outside; the first is at the
// lower end of both axes along the side.
std::array<HalfPoint, 4> cornersOfSide(const HalfPoint& lowest, int side, int length);

}  // namespace robot_tissue
