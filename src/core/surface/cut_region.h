// Where a mesh is cut: the octants (eighths of cells) of split and removed cells, and of
// the cells around them. Beyond it the mesh stays whole, as its vertices hang on whole cells.
#pragma once

#include <array>
#include <vector>

#include "geometry/bent_grid.h"
#include "robot_tissue/core/lattice.h"
#include "surface/cell_parts.h"

namespace robot_tissue {

// A value for each octant of a box, with the last ones; beyond it there is none.
template <typename Value>
class OnOctants {
 public:
  OnOctants() = default;
  OnOctants(const HalfIndex& first, const HalfIndex& last, Value all) : first_(first) {
    for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = last[axis] - first[axis] + 1;
    values_.assign(at(size_[0]) * at(size_[1]) * at(size_[2]), all);
  }

  Value* find(const HalfIndex& octant) {
    return has(octant) ? &values_[numberOf(octant)] : nullptr;
  }
  const Value* find(const HalfIndex& octant) const {
    return has(octant) ? &values_[numberOf(octant)] : nullptr;
  }

 private:
  bool has(const HalfIndex& octant) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int from_first = octant[axis] - first_[axis];
      if (from_first < 0 || from_first >= size_[axis]) return false;
    }
    return true;
  }
  std::size_t numberOf(const HalfIndex& octant) const {
    return (at(octant[0] - first_[0]) * at(size_[1]) + at(octant[1] - first_[1])) * at(size_[2]) +
           at(octant[2] - first_[2]);
  }

  HalfIndex first_{}, size_{};
  std::vector<Value> values_;
};

class CutRegion {
 public:
  CutRegion(const Lattice& lattice, const CellParts& parts);

  const std::vector<HalfIndex>& octants() const { return octants_; }  // ascending
  bool has(const HalfIndex& octant) const {
    const char* is_in = is_in_.find(octant);
    return is_in != nullptr && *is_in != 0;
  }
  // It has an octant of this box, with the last ones.
  bool reachesInto(const HalfIndex& first, const HalfIndex& last) const;
  // The cell that the octant is of; beyond the lattice the nearest one, -1: there is none.
  int cellOf(const HalfIndex& octant);
  // The cell's corner at the node that the octant belongs to, or the nearest to that.
  int cornerOf(int cell, const HalfIndex& octant) const;

 private:
  struct Octants {
    HalfIndex first{}, last{};
  };

  Octants octantsAround(const Cell& cell) const;
  void add(const Octants& octants);

  const Lattice& lattice_;
  OnOctants<int> cell_of_;  // of each octant around the region, once it was looked for
  OnOctants<char> is_in_;   // 1: the octant is in the region
  std::vector<HalfIndex> octants_;
};

}  // namespace robot_tissue
