// The cells between the nodes: 8 corners, 12 springs each. Corner c sits at the cell's lowest node
// plus (c & 1, c >> 1 & 1, c >> 2 & 1) spacings.
#pragma once

#include <array>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

constexpr int kCorners = 8;

// Corner nodes of the cell whose lowest node is (i, j, k).
std::array<int, kCorners> cellCorners(const Lattice& lattice, int i, int j, int k);

// For each corner the lowest corner of the part of the cell it belongs to; corners that uncut
// springs of the cell join are in one part. All zero in a whole cell.
std::array<int, kCorners> cellParts(const Lattice& lattice, const LatticeState& state,
                                    const std::array<int, kCorners>& corners);

// Whole cells turned inside out: the mean deformation gradient's determinant is not positive.
int countInvertedCells(const Lattice& lattice, const LatticeState& state);

}  // namespace robot_tissue
