// Forces of the cells of model `elastic` (core/material/elastic_cell.h; the energy of a cell is in
// doc/model.md), many at a time: the same numbers, barrier included, in the lanes of vector
// instructions (own). One program runs on any processor of its kind: which instructions it has is
// asked when the program starts.
//
// All lengths are in lattice spacings h, moduli in any unit E0, forces in E0 h^2.
//
// With the modes of the trilinear cell, M_s = sum over its corners k of (-1)^(bits in k and s) x_k,
//
//   F e_a = -M_a / 4,   I1 = sum over s of w_s |M_s|^2 / 16
//
// with w_s = 1, 2/3, 1/3 for modes of one, two, three axes.
#pragma once

#include <array>
#include <cstdint>

#include "material/fill_law.h"
#include "robot_tissue/core/cells.h"
#include "simd/lanes.h"
#include "simd/symmetric_kernel.h"

namespace robot_tissue {

constexpr std::size_t kNine = 9;  // numbers of a matrix, by rows

constexpr std::uint16_t kAllLanes = 0xffff;

// Cells first .. first + kLanes - 1, bits from the lowest on.
struct CellBlock {
  int first = 0;
  std::uint16_t cells = kAllLanes;  // those that count
  std::uint16_t standing = 0;       // coarse: each also holds the volumes of its eight parts
};

// Nodes are points of a grid, x fastest, one array a component; a cell has the number of its
// lowest node. Displacement and moduli reach kLanes beyond the highest node that a block touches.
template <typename Real>
struct CellGrid {
  std::array<const Real*, 3> displacement;
  const Real* shear;  // per cell, 0 where there is none
  const Real* bulk;
  const Real* stiffening;  // of the law `fung` (material/elastic_law.h); null: neo-Hookean
  int row;                 // from a node to the next along y
  int plane;               // and along z
  bool loose_stand;        // loose cells are coarse, as CellBlock::standing
  Real per_greatest;       // 1 over the greatest stiffness of a motion, in its nodes' own, at rest
  // In a time step with damping: shares of the moduli that are elastic, and that are of the strain
  // added in the step (material/viscosity.h); for that, per cell, the inverse of F where the rate
  // is taken from, by rows. Elsewhere all is elastic.
  bool has_viscosity;
  Real elastic, viscous;
  std::array<const Real*, kNine> inverse;
  // Per cell, what is added to m_1, m_2, m_4 (cell_relief.h); null: nothing, for loose cells, too.
  std::array<const Real*, kNine> relief;
  bool hasRelief() const { return relief[0] != nullptr; }
  // Where a plane of cells adds its forces, from node `origin` on: those on the cells' lower four
  // corners, and those on the upper ones, which are in the next plane of nodes.
  int origin;
  std::array<Real*, 3> lower, upper;
  // Bounds of the nodes' stiffness against moving alone (E0 h), likewise; may be null.
  SymmetricPointers<Real> lower_stiffness, upper_stiffness;
  bool findsStiffness() const { return lower_stiffness[0] != nullptr; }
};

// Adds the forces of the blocks' cells.
void addBlocks(const CellGrid<float>& grid, const CellBlock* blocks, int count);
void addBlocks(const CellGrid<double>& grid, const CellBlock* blocks, int count);

// A cell anywhere.
template <typename Real>
struct LooseCell {
  std::array<int, kCorners> nodes{};
  std::array<int, kCorners> sums{};  // where the sums on them are
  Real shear = 0;
  Real bulk = 0;
  Real stiffening = 0;
  std::array<Real, kNine> inverse{};  // CellGrid::inverse
  std::array<Real, kNine> relief{};   // CellGrid::relief
};

// Adds the forces of the cells to `lower`.
void addLoose(const CellGrid<float>& grid, const LooseCell<float>* cells, int count);
void addLoose(const CellGrid<double>& grid, const LooseCell<double>* cells, int count);

// One that is filled in part (core/material/fill_law.h; pairs by the axis that they leave out).
template <typename Real>
struct FilledCell : LooseCell<Real> {
  CellReach reach;                         // by entries
  std::array<int, kBeyond> sums_beyond{};  // where the sums on what it reaches are; < 0: none
  std::array<Real, 3> centroid{};
  std::array<Real, 3> pairs{};
  std::array<Real, kSecond*(kSecond + 1) / 2> bending{};  // lower triangle by rows
  Real twisting = 0;
  std::array<Real, 3> between_parts{};  // of a coarse cell: variance of its parts' centroids
  std::array<Real, 3> low{}, high{};    // the box at whose corners the barrier is
};

// Likewise.
void addFilled(const CellGrid<float>& grid, const FilledCell<float>* cells, int count);
void addFilled(const CellGrid<double>& grid, const FilledCell<double>* cells, int count);

}  // namespace robot_tissue
