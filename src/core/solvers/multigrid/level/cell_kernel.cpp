#include "solvers/multigrid/level/cell_kernel.h"

#include <algorithm>
#include <cstring>

#include "solvers/multigrid/level/cell_block.h"
#include "solvers/multigrid/level/filled_block.h"

namespace robot_tissue {
namespace {

using namespace vectors;

template <typename Real>
ROBOT_TISSUE_INLINE int offsetOf(const CellGrid<Real>& grid, int corner) {
  return (corner & 1) + (corner >> 1 & 1) * grid.row + (corner >> 2 & 1) * grid.plane;
}

// 1 in the lanes whose bit is set, else 0.
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes onesOf(unsigned bits) {
  typename V::Bits lanes{};
  for (int lane = 0; lane < V::kSize; ++lane) lanes[lane] = bits >> lane & 1U;
  return __builtin_convertvector(lanes, typename V::Lanes);
}

// `stiffness`: of half of the corners, without what the barrier adds.
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes stiffnessAt(
    const Block<V>& block, const typename V::Lanes (&stiffness)[kCorners / 2][kSymmetric],
    int corner, std::size_t part) {
  const typename V::Lanes& here =
      stiffness[corner < kCorners / 2 ? corner : kCorners - 1 - corner][part];
  return block.is_squeezed ? here + block.corner_stiffness[corner][part] : here;
}

// A node's sum takes its cells in ascending order, however long the vectors are: corners go from
// the highest down.
template <typename V, bool kWithStiffness, bool kStiffens>
ROBOT_TISSUE_INLINE void addBlock(const CellGrid<typename V::Real>& grid, const CellBlock& of,
                                  int lane) {
  constexpr unsigned kAll = (1U << V::kSize) - 1U;
  const unsigned cells = of.cells >> lane & kAll, standing = of.standing >> lane & kAll;
  const int first = of.first + lane;
  Block<V> block;
  for (int corner = 0; corner < kCorners; ++corner) {
    const int node = first + offsetOf(grid, corner);
    for (int axis = 0; axis < 3; ++axis) {
      block.mode[corner][axis] = load<V>(grid.displacement[axis] + node);
    }
  }
  block.shear = load<V>(grid.shear + first);
  block.bulk = load<V>(grid.bulk + first);
  if constexpr (kStiffens) block.exponent = load<V>(grid.stiffening + first);
  if (cells != kAll) {
    block.shear *= onesOf<V>(cells);
    block.bulk *= onesOf<V>(cells);
  }
  block.per_greatest = grid.per_greatest;
  block.has_parts = standing != 0;
  if (block.has_parts) block.parts = block.bulk * onesOf<V>(standing);
  if (grid.has_viscosity) {
    for (std::size_t i = 0; i < kNine; ++i) {
      block.rest_slopes[i / 3][i % 3] = load<V>(grid.inverse[i] + first);
    }
    block.divideModuli(grid.elastic, grid.viscous);
  }
  block.has_relief = grid.hasRelief();
  if (block.has_relief) {
    for (std::size_t i = 0; i < kNine; ++i) {
      block.relief[i / 3][i % 3] = load<V>(grid.relief[i] + first);
    }
  }
  block.template solve<kWithStiffness, kStiffens>();
  typename V::Lanes stiffness[kCorners / 2][kSymmetric];
  if constexpr (kWithStiffness) block.findStiffness(stiffness);
  for (int corner = kCorners - 2; corner >= 0; corner -= 2) {
    const int sum = first - grid.origin + (corner >> 1 & 1) * grid.row;
    const bool low = corner < kCorners / 2;
    for (int axis = 0; axis < 3; ++axis) {
      subtractBoth<V>(block.mode[corner][axis], block.mode[corner + 1][axis],
                      (low ? grid.lower[axis] : grid.upper[axis]) + sum);
    }
    if constexpr (kWithStiffness) {
      const auto& to = low ? grid.lower_stiffness : grid.upper_stiffness;
      for (std::size_t part = 0; part < kSymmetric; ++part) {
        subtractBoth<V>(-stiffnessAt<V>(block, stiffness, corner, part),
                        -stiffnessAt<V>(block, stiffness, corner + 1, part), to[part] + sum);
      }
    }
  }
}

template <typename V, bool kStiffens>
ROBOT_TISSUE_INLINE void addBlocksOf(const CellGrid<typename V::Real>& grid,
                                     const CellBlock* blocks, int count) {
  for (int block = 0; block < count; ++block) {
    for (int lane = 0; lane < kLanes; lane += V::kSize) {
      if (grid.findsStiffness()) {
        addBlock<V, true, kStiffens>(grid, blocks[block], lane);
      } else {
        addBlock<V, false, kStiffens>(grid, blocks[block], lane);
      }
    }
  }
}

template <typename V>
ROBOT_TISSUE_INLINE void addAllBlocks(const CellGrid<typename V::Real>& grid,
                                      const CellBlock* blocks, int count) {
  if (grid.stiffening == nullptr) {
    addBlocksOf<V, false>(grid, blocks, count);
  } else {
    addBlocksOf<V, true>(grid, blocks, count);
  }
}

// Of loose cells, filled ones, too.
template <typename V, typename Cells>
ROBOT_TISSUE_INLINE void takeViscosity(const CellGrid<typename V::Real>& grid, const Cells* cells,
                                       int count, Block<V>& block) {
  for (std::size_t i = 0; i < kNine; ++i) {
    typename V::Lanes& here = block.rest_slopes[i / 3][i % 3];
    here = typename V::Lanes{};
    for (int cell = 0; cell < count; ++cell) here[cell] = cells[cell].inverse[i];
  }
  block.divideModuli(grid.elastic, grid.viscous);
}

// Likewise.
template <typename V, typename Cells>
ROBOT_TISSUE_INLINE void takeRelief(const Cells* cells, int count, Block<V>& block) {
  block.has_relief = true;
  for (std::size_t i = 0; i < kNine; ++i) {
    typename V::Lanes& here = block.relief[i / 3][i % 3];
    here = typename V::Lanes{};
    for (int cell = 0; cell < count; ++cell) here[cell] = cells[cell].relief[i];
  }
}

template <typename V>
ROBOT_TISSUE_INLINE void addLooseBlock(const CellGrid<typename V::Real>& grid,
                                       const LooseCell<typename V::Real>* cells, int count) {
  Block<V> block;
  block.shear = block.bulk = block.exponent = typename V::Lanes{};
  for (auto& corner : block.mode) corner[0] = corner[1] = corner[2] = typename V::Lanes{};
  for (int cell = 0; cell < count; ++cell) {
    block.shear[cell] = cells[cell].shear;
    block.bulk[cell] = cells[cell].bulk;
    block.exponent[cell] = cells[cell].stiffening;
    for (int corner = 0; corner < kCorners; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        block.mode[corner][axis][cell] = grid.displacement[at(axis)][cells[cell].nodes[at(corner)]];
      }
    }
  }
  block.per_greatest = grid.per_greatest;
  block.has_parts = grid.loose_stand;
  block.parts = block.bulk;
  if (grid.has_viscosity) takeViscosity<V>(grid, cells, count, block);
  if (grid.hasRelief()) takeRelief<V>(cells, count, block);
  if (grid.stiffening == nullptr) {
    block.template solve<true, false>();
  } else {
    block.template solve<true, true>();
  }
  typename V::Lanes stiffness[kCorners / 2][kSymmetric];
  block.findStiffness(stiffness);
  for (int cell = 0; cell < count; ++cell) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const int sum = cells[cell].sums[at(corner)];
      for (int axis = 0; axis < 3; ++axis) {
        grid.lower[at(axis)][sum] -= block.mode[corner][axis][cell];
      }
      for (std::size_t part = 0; part < kSymmetric && grid.findsStiffness(); ++part) {
        grid.lower_stiffness[part][sum] += stiffnessAt<V>(block, stiffness, corner, part)[cell];
      }
    }
  }
}

// Calls visit(side, r, the corner before it, node) for the nodes that the cell reaches.
template <typename Real, typename Visit>
ROBOT_TISSUE_INLINE void forReached(const FilledCell<Real>& cell, const Visit& visit) {
  for (int side = 0; side < kSides; ++side) {
    for (int r = 0; cell.reach.has(side) && r < kFaceNodes; ++r) {
      visit(side, r, faceCorner(side, r), cell.reach.nodes[at(kFaceNodes * side + r)]);
    }
  }
}

template <typename V>
ROBOT_TISSUE_INLINE void addFilledBlock(const CellGrid<typename V::Real>& grid,
                                        const FilledCell<typename V::Real>* cells, int count) {
  using Real = typename V::Real;
  using L = typename V::Lanes;
  FilledBlock<V> block;
  typename FilledBlock<V>::Fill fill;
  block.shear = block.bulk = block.exponent = L{};
  for (auto& corner : block.mode) corner[0] = corner[1] = corner[2] = L{};
  for (auto* values :
       {&fill.centroid, &fill.pairs, &fill.between_parts, &fill.box.sides[0], &fill.box.sides[1]}) {
    for (L& value : *values) value = L{};
  }
  for (auto* values : {&fill.in_strain, &fill.in_mean, &fill.in_uneven}) {
    for (L& value : *values) value = L{};
  }
  for (L& value : fill.bending) value = L{};
  fill.twisting = L{};
  std::memset(block.beyond, 0, sizeof block.beyond);
  for (int cell = 0; cell < count; ++cell) {
    const auto& of = cells[cell];
    block.shear[cell] = of.shear;
    block.bulk[cell] = of.bulk;
    block.exponent[cell] = of.stiffening;
    for (int axis = 0; axis < 3; ++axis) {
      fill.centroid[axis][cell] = of.centroid[at(axis)];
      fill.pairs[axis][cell] = of.pairs[at(axis)];
      fill.between_parts[axis][cell] = of.between_parts[at(axis)];
      fill.box.sides[0][axis][cell] = Real(-2) * of.low[at(axis)];
      fill.box.sides[1][axis][cell] = Real(-2) * of.high[at(axis)];
      for (int corner = 0; corner < kCorners; ++corner) {
        block.mode[corner][axis][cell] = grid.displacement[at(axis)][of.nodes[at(corner)]];
      }
    }
    for (std::size_t part = 0; part < of.bending.size(); ++part) {
      fill.bending[part][cell] = of.bending[part];
    }
    fill.twisting[cell] = of.twisting;
    for (int side = 0; side < kSides; ++side) {
      fill.in_strain[side][cell] = static_cast<Real>(of.reach.share[at(side)]);
      fill.in_mean[side][cell] = static_cast<Real>(of.reach.inMean(side));
      fill.in_uneven[side][cell] = static_cast<Real>(of.reach.inUneven(side));
    }
    forReached(of, [&](int side, int r, int before, int node) {
      for (int axis = 0; axis < 3; ++axis) {
        const Real* moved = grid.displacement[at(axis)];
        block.beyond[side][r][axis][cell] = moved[node] - moved[of.nodes[at(before)]];
      }
    });
  }
  block.per_greatest = grid.per_greatest;
  block.has_parts = grid.loose_stand;
  block.parts = block.bulk;
  if (grid.has_viscosity) takeViscosity<V>(grid, cells, count, block);
  if (grid.hasRelief()) takeRelief<V>(cells, count, block);
  L stiffness[kMostReached][kSymmetric];
  L(*const asked)[kSymmetric] = grid.findsStiffness() ? stiffness : nullptr;
  if (grid.stiffening == nullptr) {
    block.template solveFill<false>(fill, asked);
  } else {
    block.template solveFill<true>(fill, asked);
  }
  for (int cell = 0; cell < count; ++cell) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const int sum = cells[cell].sums[at(corner)];
      for (int axis = 0; axis < 3; ++axis) {
        grid.lower[at(axis)][sum] -= block.mode[corner][axis][cell];
      }
      for (std::size_t part = 0; part < kSymmetric && grid.findsStiffness(); ++part) {
        grid.lower_stiffness[part][sum] += stiffness[corner][part][cell];
      }
    }
    forReached(cells[cell], [&](int side, int r, int before, int) {
      const int place = kFaceNodes * side + r;
      const int sum = cells[cell].sums_beyond[at(place)];
      const int sum_before = cells[cell].sums[at(before)];
      for (int axis = 0; axis < 3; ++axis) {
        grid.lower[at(axis)][sum] -= block.beyond[side][r][axis][cell];
        grid.lower[at(axis)][sum_before] += block.beyond[side][r][axis][cell];
      }
      for (std::size_t part = 0; part < kSymmetric && grid.findsStiffness(); ++part) {
        grid.lower_stiffness[part][sum] += stiffness[kCorners + place][part][cell];
      }
    });
  }
}

template <typename V>
ROBOT_TISSUE_INLINE void addAllFilled(const CellGrid<typename V::Real>& grid,
                                      const FilledCell<typename V::Real>* cells, int count) {
  constexpr int kSize = V::kSize;
  for (int cell = 0; cell < count; cell += kSize) {
    addFilledBlock<V>(grid, cells + cell, std::min(kSize, count - cell));
  }
}

template <typename V>
ROBOT_TISSUE_INLINE void addAllLoose(const CellGrid<typename V::Real>& grid,
                                     const LooseCell<typename V::Real>* cells, int count) {
  constexpr int kSize = V::kSize;
  for (int cell = 0; cell < count; cell += kSize) {
    addLooseBlock<V>(grid, cells + cell, std::min(kSize, count - cell));
  }
}

}  // namespace

// For one kind of processor.
#define ROBOT_TISSUE_KERNELS(kind, bytes)                                                         \
  kind void addBlocksHere(const CellGrid<float>& grid, const CellBlock* blocks, int count) {      \
    addAllBlocks<Vector<float, bytes>>(grid, blocks, count);                                      \
  }                                                                                               \
  kind void addBlocksHere(const CellGrid<double>& grid, const CellBlock* blocks, int count) {     \
    addAllBlocks<Vector<double, bytes>>(grid, blocks, count);                                     \
  }                                                                                               \
  kind void addLooseHere(const CellGrid<float>& grid, const LooseCell<float>* cells, int count) { \
    addAllLoose<Vector<float, bytes>>(grid, cells, count);                                        \
  }                                                                                               \
  kind void addLooseHere(const CellGrid<double>& grid, const LooseCell<double>* cells,            \
                         int count) {                                                             \
    addAllLoose<Vector<double, bytes>>(grid, cells, count);                                       \
  }                                                                                               \
  kind void addFilledHere(const CellGrid<float>& grid, const FilledCell<float>* cells,            \
                          int count) {                                                            \
    addAllFilled<Vector<float, bytes>>(grid, cells, count);                                       \
  }                                                                                               \
  kind void addFilledHere(const CellGrid<double>& grid, const FilledCell<double>* cells,          \
                          int count) {                                                            \
    addAllFilled<Vector<double, bytes>>(grid, cells, count);                                      \
  }

ROBOT_TISSUE_FOR_EACH_PROCESSOR(ROBOT_TISSUE_KERNELS)

// Which kind is asked only where all are seen.
void addBlocks(const CellGrid<float>& grid, const CellBlock* blocks, int count) {
  addBlocksHere(grid, blocks, count);
}

void addBlocks(const CellGrid<double>& grid, const CellBlock* blocks, int count) {
  addBlocksHere(grid, blocks, count);
}

void addLoose(const CellGrid<float>& grid, const LooseCell<float>* cells, int count) {
  addLooseHere(grid, cells, count);
}

void addLoose(const CellGrid<double>& grid, const LooseCell<double>* cells, int count) {
  addLooseHere(grid, cells, count);
}

void addFilled(const CellGrid<float>& grid, const FilledCell<float>* cells, int count) {
  addFilledHere(grid, cells, count);
}

void addFilled(const CellGrid<double>& grid, const FilledCell<double>* cells, int count) {
  addFilledHere(grid, cells, count);
}

}  // namespace robot_tissue
