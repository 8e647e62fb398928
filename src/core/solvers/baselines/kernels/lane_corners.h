// What kernels that look at cells share: from a cell's modes to gradients in its corners.
#pragma once

#include "solvers/baselines/kernels/lane_kernels.h"
#include "solvers/baselines/kernels/lane_math.h"

namespace robot_tissue {

// A cell's modes along one axis, turned into the gradients in its corners.
ROBOT_TISSUE_INLINE void spread(const Modes& m, Lane* pull, int i) {
  const float ss = m.z, sd0 = m.y + m.yz, sd1 = m.y - m.yz;
  const float ds0 = m.x + m.xz, ds1 = m.x - m.xz, dd0 = m.xy + m.xyz, dd1 = m.xy - m.xyz;
  const float s01 = ss + sd0, s23 = ss - sd0, d01 = ds0 + dd0, d23 = ds0 - dd0;
  const float s45 = sd1 - ss, s67 = -ss - sd1, d45 = ds1 + dd1, d67 = ds1 - dd1;
  pull[0][i] = s01 + d01;
  pull[1][i] = s01 - d01;
  pull[2][i] = s23 + d23;
  pull[3][i] = s23 - d23;
  pull[4][i] = s45 + d45;
  pull[5][i] = s45 - d45;
  pull[6][i] = s67 + d67;
  pull[7][i] = s67 - d67;
}

// Gradients along one axis: a w_s M_s, and of J by the cofactors.
ROBOT_TISSUE_INLINE Modes gradientModes(const Modes& m, float a, float jx, float jy, float jz) {
  const float bent = 2.0F * kThird * a;
  return {a * m.x + jx, a * m.y + jy, a * m.z + jz,      bent * m.xy,
          bent * m.xz,  bent * m.yz,  kThird * a * m.xyz};
}

// Gradients in the corners along all axes: of a I1 / 2, and of -J times p.
ROBOT_TISSUE_INLINE void spreadAll(const Modes& mx, const Modes& my, const Modes& mz, float a,
                                   float p, const Cofactors& by, Lane pull[3][kCorners], int i) {
  const Vector &x = by.of_x, &y = by.of_y, &z = by.of_z;
  spread(gradientModes(mx, a, p * x.x, p * x.y, p * x.z), pull[0], i);
  spread(gradientModes(my, a, p * y.x, p * y.y, p * y.z), pull[1], i);
  spread(gradientModes(mz, a, p * z.x, p * z.y, p * z.z), pull[2], i);
}

// The barrier at one corner of each cell, in its four nodes.
ROBOT_TISSUE_INLINE void addBarrierPull(const SoaArrays& lanes, const ColoredLayout::Around& above,
                                        int block, int corner, Lane pull[3][kCorners]) {
  const float* const at[3] = {lanes.moved[0] + block, lanes.moved[1] + block,
                              lanes.moved[2] + block};
  const float* const shears = lanes.shear + block;
  const int own = above.corner[corner];
  const int to_x = corner ^ 1, to_y = corner ^ 2, to_z = corner ^ 4;
  const int far_x = above.corner[to_x], far_y = above.corner[to_y], far_z = above.corner[to_z];
  const float sx = (corner & 1) != 0 ? 1.0F : -1.0F;
  const float sy = (corner & 2) != 0 ? 1.0F : -1.0F;
  const float sz = (corner & 4) != 0 ? 1.0F : -1.0F;
  Lane slope[3][3];
  for (int i = 0; i < kLanes; ++i) {
    const Vector x = edgeOf(at, own, far_x, sx, {1.0F, 0.0F, 0.0F}, i);
    const Vector y = edgeOf(at, own, far_y, sy, {0.0F, 1.0F, 0.0F}, i);
    const Vector z = edgeOf(at, own, far_z, sz, {0.0F, 0.0F, 1.0F}, i);
    const Vector yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    const float by = 4.0F * barrierOf(shears[i], dot(x, yz)).slope;
    const float by_x = by * sx, by_y = by * sy, by_z = by * sz;
    slope[0][0][i] = by_x * yz.x, slope[1][0][i] = by_x * yz.y, slope[2][0][i] = by_x * yz.z;
    slope[0][1][i] = by_y * zx.x, slope[1][1][i] = by_y * zx.y, slope[2][1][i] = by_y * zx.z;
    slope[0][2][i] = by_z * xy.x, slope[1][2][i] = by_z * xy.y, slope[2][2][i] = by_z * xy.z;
  }
  for (int axis = 0; axis < 3; ++axis) {
    ROBOT_TISSUE_ROLLED
    for (int i = 0; i < kLanes; ++i) {
      const float x = slope[axis][0][i], y = slope[axis][1][i], z = slope[axis][2][i];
      pull[axis][corner][i] += x + y + z;
      pull[axis][to_x][i] -= x;
      pull[axis][to_y][i] -= y;
      pull[axis][to_z][i] -= z;
    }
  }
}

// Twice the density of the barrier at one corner of each cell.
ROBOT_TISSUE_INLINE void addBarrierEnergy(const SoaArrays& lanes,
                                          const ColoredLayout::Around& above, int block, int corner,
                                          Lane& energy) {
  const float* const at[3] = {lanes.moved[0] + block, lanes.moved[1] + block,
                              lanes.moved[2] + block};
  const float* const shears = lanes.shear + block;
  const int own = above.corner[corner];
  const int far_x = above.corner[corner ^ 1], far_y = above.corner[corner ^ 2];
  const int far_z = above.corner[corner ^ 4];
  const float sx = (corner & 1) != 0 ? 1.0F : -1.0F;
  const float sy = (corner & 2) != 0 ? 1.0F : -1.0F;
  const float sz = (corner & 4) != 0 ? 1.0F : -1.0F;
  ROBOT_TISSUE_ROLLED
  for (int i = 0; i < kLanes; ++i) {
    const Vector x = edgeOf(at, own, far_x, sx, {1.0F, 0.0F, 0.0F}, i);
    const Vector y = edgeOf(at, own, far_y, sy, {0.0F, 1.0F, 0.0F}, i);
    const Vector z = edgeOf(at, own, far_z, sz, {0.0F, 0.0F, 1.0F}, i);
    const float spanned = dot(x, cross(y, z));
    const float depth = spanned < kSqueezed ? (kSqueezed - spanned) / kSqueezed : 0.0F;
    energy[i] += 2.0F * kBarrier * shears[i] * depth * depth * depth;
  }
}

}  // namespace robot_tissue
