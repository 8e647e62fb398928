// Kernels that move nodes.
#include <cmath>

#include "solvers/baselines/kernels/lane_kernels.h"
#include "solvers/baselines/kernels/lane_math.h"

namespace robot_tissue {
namespace {

constexpr float kLeastShare = 1e-4F;  // of a block's trace cubed that its determinant must be

// A node's cells, as CellModes sees them from there: l and c of core/material/cell_modes.h, J and
// I1; then a, and the derivatives of a and of the energy's density by J, the last one halved.
struct NodeCells {
  Lane l[kCorners][3], c[kCorners][3];
  Lane volume[kCorners], invariant[kCorners];
  Lane a[kCorners], slope[kCorners], pressure[kCorners], half[kCorners];
};

ROBOT_TISSUE_INLINE float pullOf(const Modes& m) {
  return m.x + m.y + m.z + (2.0F * (m.xy + m.xz + m.yz) + m.xyz) * kThird;
}

ROBOT_TISSUE_INLINE void measure(const SoaArrays& lanes, const ColoredLayout::Around& around,
                                 int block, int cell, NodeCells& cells) {
  const float* const x = lanes.moved[0] + block;
  const float* const y = lanes.moved[1] + block;
  const float* const z = lanes.moved[2] + block;
  int k[kCorners];
  for (int corner = 0; corner < kCorners; ++corner) k[corner] = around.corner[corner];
  const float side_x = around.side[0], side_y = around.side[1], side_z = around.side[2];
  const float hand = side_x * side_y * side_z;
  for (int i = 0; i < kLanes; ++i) {
    Modes mx = cellModes(x, k, i), my = cellModes(y, k, i), mz = cellModes(z, k, i);
    mx.x += side_x;
    my.y += side_y;
    mz.z += side_z;
    const float bx = mx.y - mx.x, by = my.y - my.x, bz = mz.y - mz.x;
    const float cx = mx.z - mx.x, cy = my.z - my.x, cz = mz.z - mz.x;
    const float jx = hand * (by * cz - bz * cy);
    const float jy = hand * (bz * cx - bx * cz);
    const float jz = hand * (bx * cy - by * cx);
    cells.c[cell][0][i] = jx;
    cells.c[cell][1][i] = jy;
    cells.c[cell][2][i] = jz;
    cells.volume[cell][i] = mx.x * jx + my.x * jy + mz.x * jz;
    cells.invariant[cell][i] = invariantOf(mx, my, mz);
    cells.l[cell][0][i] = pullOf(mx);
    cells.l[cell][1][i] = pullOf(my);
    cells.l[cell][2][i] = pullOf(mz);
  }
}

ROBOT_TISSUE_INLINE void stiffen(const SoaArrays& lanes, const ColoredLayout::Around& around,
                                 int block, int cell, NodeCells& cells) {
  const float* const shear = lanes.shear + block + around.cell;
  const float* const bulk = lanes.bulk + block + around.cell;
  for (int i = 0; i < kLanes; ++i) {
    const float volume = cells.volume[cell][i], invariant = cells.invariant[cell][i];
    const Stiffening s = stiffeningOf(shear[i], volume);
    cells.a[cell][i] = s.a;
    cells.slope[cell][i] = s.slope;
    cells.pressure[cell][i] = 0.5F * s.slope * invariant + bulk[i] * (volume - 1.0F);
    cells.half[cell][i] = 0.25F * s.curvature * invariant + 0.5F * bulk[i];
  }
}

// Sums over a node's cells: forces, and the block without what a adds to its diagonal.
struct NodeSums {
  float x, y, z;
  float xx, yy, zz, xy, xz, yz;
  float a;
};

// What springs and barriers add to a node's sums.
struct NodeExtras {
  Lane force[3] = {};
  Lane block[6] = {};
  Lane barrier = {};  // sum of its curvatures
};

ROBOT_TISSUE_INLINE NodeSums startAt(const SoaArrays& lanes, const NodeExtras& extras, int block,
                                     int i) {
  NodeSums sums;
  sums.x = lanes.load[0][block + i] + extras.force[0][i];
  sums.y = lanes.load[1][block + i] + extras.force[1][i];
  sums.z = lanes.load[2][block + i] + extras.force[2][i];
  sums.xx = extras.block[0][i];
  sums.yy = extras.block[1][i];
  sums.zz = extras.block[2][i];
  sums.xy = extras.block[3][i];
  sums.xz = extras.block[4][i];
  sums.yz = extras.block[5][i];
  sums.a = 0.0F;
  return sums;
}

ROBOT_TISSUE_INLINE void addSprings(const SoaArrays& lanes, const SoaSprings& springs, int block,
                                    NodeExtras& extras) {
  for (int i = 0; i < kLanes; ++i) {
    const float x = lanes.moved[0][block + i];
    const float y = lanes.moved[1][block + i];
    const float z = lanes.moved[2][block + i];
    const float xx = springs.of[0][i], yy = springs.of[1][i], zz = springs.of[2][i];
    const float xy = springs.of[3][i], xz = springs.of[4][i], yz = springs.of[5][i];
    extras.force[0][i] = -(xx * x + xy * y + xz * z);
    extras.force[1][i] = -(xy * x + yy * y + yz * z);
    extras.force[2][i] = -(xz * x + yz * y + zz * z);
    extras.block[0][i] = xx;
    extras.block[1][i] = yy;
    extras.block[2][i] = zz;
    extras.block[3][i] = xy;
    extras.block[4][i] = xz;
    extras.block[5][i] = yz;
  }
}

// Of a spanned determinant that has this slope in the node.
ROBOT_TISSUE_INLINE void addCorner(float shear, float spanned, const Vector& slope, int i,
                                   NodeExtras& extras) {
  const Barrier barrier = barrierOf(shear, spanned);
  const float pull = -4.0F * barrier.slope, stiffness = 16.0F * barrier.curvature;
  extras.barrier[i] += barrier.curvature;
  extras.force[0][i] += pull * slope.x;
  extras.force[1][i] += pull * slope.y;
  extras.force[2][i] += pull * slope.z;
  extras.block[0][i] += stiffness * slope.x * slope.x;
  extras.block[1][i] += stiffness * slope.y * slope.y;
  extras.block[2][i] += stiffness * slope.z * slope.z;
  extras.block[3][i] += stiffness * slope.x * slope.y;
  extras.block[4][i] += stiffness * slope.x * slope.z;
  extras.block[5][i] += stiffness * slope.y * slope.z;
}

// The barrier of one cell around each node: the node is in the edges of its own corner, and in one
// at each of the three corners next to it.
ROBOT_TISSUE_INLINE void addBarrier(const SoaArrays& lanes, const ColoredLayout::Around& around,
                                    int block, NodeExtras& extras) {
  const float* const at[3] = {lanes.moved[0] + block, lanes.moved[1] + block,
                              lanes.moved[2] + block};
  const float* const shears = lanes.shear + block + around.cell;
  const int k1 = around.corner[1], k2 = around.corner[2], k3 = around.corner[3];
  const int k4 = around.corner[4], k5 = around.corner[5], k6 = around.corner[6];
  const float sx = around.side[0], sy = around.side[1], sz = around.side[2];
  for (int i = 0; i < kLanes; ++i) {
    const Vector rest_x = {1.0F, 0.0F, 0.0F}, rest_y = {0.0F, 1.0F, 0.0F};
    const Vector rest_z = {0.0F, 0.0F, 1.0F};
    const Vector x = edgeOf(at, 0, k1, sx, rest_x, i), y = edgeOf(at, 0, k2, sy, rest_y, i);
    const Vector z = edgeOf(at, 0, k4, sz, rest_z, i);
    const Vector yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    const Vector own = {sx * yz.x + sy * zx.x + sz * xy.x, sx * yz.y + sy * zx.y + sz * xy.y,
                        sx * yz.z + sy * zx.z + sz * xy.z};
    addCorner(shears[i], dot(x, yz), own, i, extras);
    const Vector at_x = cross(edgeOf(at, k1, k3, sy, rest_y, i), edgeOf(at, k1, k5, sz, rest_z, i));
    addCorner(shears[i], dot(x, at_x), {sx * at_x.x, sx * at_x.y, sx * at_x.z}, i, extras);
    const Vector at_y = cross(edgeOf(at, k2, k6, sz, rest_z, i), edgeOf(at, k2, k3, sx, rest_x, i));
    addCorner(shears[i], dot(y, at_y), {sy * at_y.x, sy * at_y.y, sy * at_y.z}, i, extras);
    const Vector at_z = cross(edgeOf(at, k4, k5, sx, rest_x, i), edgeOf(at, k4, k6, sy, rest_y, i));
    addCorner(shears[i], dot(z, at_z), {sz * at_z.x, sz * at_z.y, sz * at_z.z}, i, extras);
  }
}

// From the neo-Hookean law, which `stiffen` leaves, to `fung`: as ElasticCell::findLaw. What g''
// adds to the block, mu/2 g'' n n^T with n = 2 w l + w' I1 c the slope of x, is among the extras.
ROBOT_TISSUE_INLINE void stiffenByStrain(const SoaArrays& lanes,
                                         const ColoredLayout::Around& around, int block, int cell,
                                         NodeCells& cells, NodeExtras& extras) {
  const float* const x = lanes.moved[0] + block;
  const float* const y = lanes.moved[1] + block;
  const float* const z = lanes.moved[2] + block;
  const float* const shear = lanes.shear + block + around.cell;
  const float* const bulk = lanes.bulk + block + around.cell;
  const float* const stiffening = lanes.stiffening + block + around.cell;
  int k[kCorners];
  for (int corner = 0; corner < kCorners; ++corner) k[corner] = around.corner[corner];
  for (int i = 0; i < kLanes; ++i) {
    const Strain strain =
        strainOf(cellModes(x, k, i), cellModes(y, k, i), cellModes(z, k, i), around.side);
    const Stiffening w = stiffeningOf(1.0F, 1.0F + strain.growth);
    const StrainStiffening g = strainStiffeningOf(stiffening[i], shapeStrainOf(strain, w.a));
    const float invariant = 3.0F + strain.excess, by_volume = w.slope * invariant;
    cells.a[cell][i] *= g.slope;
    cells.slope[cell][i] *= g.slope;
    cells.pressure[cell][i] = 0.5F * g.slope * shear[i] * by_volume + bulk[i] * strain.growth;
    cells.half[cell][i] = 0.25F * g.slope * shear[i] * w.curvature * invariant + 0.5F * bulk[i];
    const float steep = 0.5F * shear[i] * g.curvature;
    const float nx = 2.0F * w.a * cells.l[cell][0][i] + by_volume * cells.c[cell][0][i];
    const float ny = 2.0F * w.a * cells.l[cell][1][i] + by_volume * cells.c[cell][1][i];
    const float nz = 2.0F * w.a * cells.l[cell][2][i] + by_volume * cells.c[cell][2][i];
    extras.block[0][i] += steep * nx * nx;
    extras.block[1][i] += steep * ny * ny;
    extras.block[2][i] += steep * nz * nz;
    extras.block[3][i] += steep * nx * ny;
    extras.block[4][i] += steep * nx * nz;
    extras.block[5][i] += steep * ny * nz;
  }
}

ROBOT_TISSUE_INLINE NodeSums add(NodeSums sums, const NodeCells& cells, int cell, int i) {
  const float lx = cells.l[cell][0][i], ly = cells.l[cell][1][i], lz = cells.l[cell][2][i];
  const float jx = cells.c[cell][0][i], jy = cells.c[cell][1][i], jz = cells.c[cell][2][i];
  const float a = cells.a[cell][i], pressure = cells.pressure[cell][i];
  const float slope = cells.slope[cell][i], half = cells.half[cell][i];
  const float hx = slope * lx + half * jx, hy = slope * ly + half * jy, hz = slope * lz + half * jz;
  sums.x -= a * lx + pressure * jx;
  sums.y -= a * ly + pressure * jy;
  sums.z -= a * lz + pressure * jz;
  sums.xx += 2.0F * hx * jx;
  sums.yy += 2.0F * hy * jy;
  sums.zz += 2.0F * hz * jz;
  sums.xy += hx * jy + jx * hy;
  sums.xz += hx * jz + jx * hz;
  sums.yz += hy * jz + jy * hz;
  sums.a += a;
  return sums;
}

// Solves by cofactors. Where the block is all but singular, one step down the force.
ROBOT_TISSUE_INLINE void moveNode(const SoaArrays& lanes, int block, const NodeSums& sums,
                                  float relaxation, float most, Lane step[3], int i) {
  const float free_x = lanes.free[0][block + i];
  const float free_y = lanes.free[1][block + i];
  const float free_z = lanes.free[2][block + i];
  const float fx = free_x * sums.x, fy = free_y * sums.y, fz = free_z * sums.z;
  const float even = 16.0F * kThird * sums.a;
  const float held = even > 0.0F ? even : 1.0F;
  const float xx = free_x * (even + sums.xx - held) + held;
  const float yy = free_y * (even + sums.yy - held) + held;
  const float zz = free_z * (even + sums.zz - held) + held;
  const float xy = free_x * free_y * sums.xy;
  const float xz = free_x * free_z * sums.xz;
  const float yz = free_y * free_z * sums.yz;
  const float cxx = yy * zz - yz * yz, cxy = yz * xz - xy * zz, cxz = xy * yz - yy * xz;
  const float cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
  const float determinant = xx * cxx + xy * cxy + xz * cxz;
  const float trace = xx + yy + zz;
  const bool sound = determinant > kLeastShare * trace * trace * trace;
  const float by = relaxation / (sound ? determinant : trace);
  const float sx = by * (sound ? cxx * fx + cxy * fy + cxz * fz : fx);
  const float sy = by * (sound ? cxy * fx + cyy * fy + cyz * fz : fy);
  const float sz = by * (sound ? cxz * fx + cyz * fy + czz * fz : fz);
  const float squared = sx * sx + sy * sy + sz * sz;
  const float share = squared > most * most ? most / std::sqrt(squared) : 1.0F;
  step[0][i] = share * sx;
  step[1][i] = share * sy;
  step[2][i] = share * sz;
}

ROBOT_TISSUE_INLINE void lookAround(const SoaArrays& lanes,
                                    const std::array<ColoredLayout::Around, kCorners>& around,
                                    int block, const SoaSprings* springs, bool squeezed,
                                    NodeCells& cells, NodeExtras& extras) {
  if (springs != nullptr) addSprings(lanes, *springs, block, extras);
  if (squeezed) {
    for (const ColoredLayout::Around& cell : around) addBarrier(lanes, cell, block, extras);
  }
  for (int cell = 0; cell < kCorners; ++cell) measure(lanes, around[at(cell)], block, cell, cells);
  for (int cell = 0; cell < kCorners; ++cell) stiffen(lanes, around[at(cell)], block, cell, cells);
  if (lanes.stiffening == nullptr) return;
  for (int cell = 0; cell < kCorners; ++cell) {
    stiffenByStrain(lanes, around[at(cell)], block, cell, cells, extras);
  }
}

ROBOT_TISSUE_INLINE NodeSums sumsOf(const SoaArrays& lanes, const NodeExtras& extras,
                                    const NodeCells& cells, int block, int i) {
  NodeSums sums = startAt(lanes, extras, block, i);
  sums = add(sums, cells, 0, i);
  sums = add(sums, cells, 1, i);
  sums = add(sums, cells, 2, i);
  sums = add(sums, cells, 3, i);
  sums = add(sums, cells, 4, i);
  sums = add(sums, cells, 5, i);
  sums = add(sums, cells, 6, i);
  return add(sums, cells, 7, i);
}

}  // namespace

ROBOT_TISSUE_CLONES
void softnessOfBlock(const SoaArrays& lanes,
                     const std::array<ColoredLayout::Around, kCorners>& around, int block,
                     const SoaSprings* springs, bool squeezed, float* softness) {
  NodeCells cells;
  NodeExtras extras;
  lookAround(lanes, around, block, springs, squeezed, cells, extras);
  Lane soft;
  for (int i = 0; i < kLanes; ++i) {
    const NodeSums sums = sumsOf(lanes, extras, cells, block, i);
    const float even = 16.0F * kThird * sums.a;
    const float xy = std::abs(sums.xy), xz = std::abs(sums.xz), yz = std::abs(sums.yz);
    const float x = even + sums.xx + xy + xz;
    const float y = even + sums.yy + xy + yz;
    const float z = even + sums.zz + xz + yz;
    const float more = x > y ? x : y;
    const float most = more > z ? more : z;
    soft[i] = most > 0.0F ? 1.0F / most : 0.0F;
  }
  ROBOT_TISSUE_ROLLED
  for (int i = 0; i < kLanes; ++i) softness[block + i] = soft[i];
}

ROBOT_TISSUE_CLONES
void relaxBlock(const SoaArrays& lanes, const std::array<ColoredLayout::Around, kCorners>& around,
                int block, const SoaSprings* springs, bool squeezed, float relaxation, float most) {
  NodeCells cells;
  NodeExtras extras;
  Lane step[3];
  lookAround(lanes, around, block, springs, squeezed, cells, extras);
  for (int i = 0; i < kLanes; ++i) {
    const NodeSums sums = sumsOf(lanes, extras, cells, block, i);
    // A barrier is too crooked for more than Newton's own step.
    const float share = extras.barrier[i] > 0.0F ? 1.0F : relaxation;
    moveNode(lanes, block, sums, share, most, step, i);
  }
  for (int axis = 0; axis < 3; ++axis) {
    float* const moved = lanes.moved[axis] + block;
    ROBOT_TISSUE_ROLLED
    for (int i = 0; i < kLanes; ++i) moved[i] += step[axis][i];
  }
}

}  // namespace robot_tissue
