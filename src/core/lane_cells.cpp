// Kernels that look at cells.
#include "lane_kernels.h"
#include "lane_math.h"

namespace robot_tissue {
namespace {

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

// From the lowest corner: sides and hand are -1.
ROBOT_TISSUE_INLINE void pullCorners(const LaneArrays& lanes, const LaneGrid::Around& above,
                                     int block, Lane pull[3][kCorners]) {
  const float* const x = lanes.moved[0] + block;
  const float* const y = lanes.moved[1] + block;
  const float* const z = lanes.moved[2] + block;
  const float* const shears = lanes.shear + block;
  const float* const bulks = lanes.bulk + block;
  int k[kCorners];
  for (int corner = 0; corner < kCorners; ++corner) k[corner] = above.corner[corner];
  for (int i = 0; i < kLanes; ++i) {
    Modes mx = cellModes(x, k, i), my = cellModes(y, k, i), mz = cellModes(z, k, i);
    mx.x -= 1.0F;
    my.y -= 1.0F;
    mz.z -= 1.0F;
    const float invariant = invariantOf(mx, my, mz);
    // Cofactors of the columns x, y, z of the modes.
    const float xx = my.y * mz.z - mz.y * my.z, xy = mz.y * mx.z - mx.y * mz.z;
    const float xz = mx.y * my.z - my.y * mx.z;
    const float yx = my.z * mz.x - mz.z * my.x, yy = mz.z * mx.x - mx.z * mz.x;
    const float yz = mx.z * my.x - my.z * mx.x;
    const float zx = my.x * mz.y - mz.x * my.y, zy = mz.x * mx.y - mx.x * mz.y;
    const float zz = mx.x * my.y - my.x * mx.y;
    const float volume = -(mx.x * xx + my.x * xy + mz.x * xz);
    const Stiffening s = stiffeningOf(shears[i], volume);
    const float p = -(0.5F * s.slope * invariant + bulks[i] * (volume - 1.0F));
    spread(gradientModes(mx, s.a, p * xx, p * yx, p * zx), pull[0], i);
    spread(gradientModes(my, s.a, p * xy, p * yy, p * zy), pull[1], i);
    spread(gradientModes(mz, s.a, p * xz, p * yz, p * zz), pull[2], i);
  }
}

// The edge at a corner along an axis is the mean edge plus the modes that change sign along it.
ROBOT_TISSUE_INLINE float edge(float mean, float a, float b, float ab, float sa, float sb) {
  return mean + sa * a + sb * b + sa * sb * ab;
}

// Edges at a corner along x, y and z: their components along one axis. `sign` is 1 at the lower
// end.
ROBOT_TISSUE_INLINE void edgesAt(const Lane modes[7], const float sign[3], Lane edges[3]) {
  for (int i = 0; i < kLanes; ++i) {
    const float xy = modes[3][i], xz = modes[4][i], yz = modes[5][i], xyz = modes[6][i];
    edges[0][i] = edge(modes[0][i], xy, xz, xyz, sign[1], sign[2]);
    edges[1][i] = edge(modes[1][i], xy, yz, xyz, sign[0], sign[2]);
    edges[2][i] = edge(modes[2][i], xz, yz, xyz, sign[0], sign[1]);
  }
}

// Modes of the corners' places from the lowest one.
ROBOT_TISSUE_INLINE void placeModes(const float* x, const int* k, const float rest[3],
                                    Lane modes[7]) {
  for (int i = 0; i < kLanes; ++i) {
    const Modes m = cellModes(x, k, i);
    modes[0][i] = m.x - rest[0];
    modes[1][i] = m.y - rest[1];
    modes[2][i] = m.z - rest[2];
    modes[3][i] = m.xy;
    modes[4][i] = m.xz;
    modes[5][i] = m.yz;
    modes[6][i] = m.xyz;
  }
}

ROBOT_TISSUE_INLINE void tightestCorners(const LaneArrays& lanes, const LaneGrid::Around& above,
                                         int block, Lane& least) {
  static constexpr float kRest[3][3] = {{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}};
  int k[kCorners];
  for (int corner = 0; corner < kCorners; ++corner) k[corner] = above.corner[corner];
  Lane modes[3][7], edges[3][3];
  for (int axis = 0; axis < 3; ++axis) {
    placeModes(lanes.moved[axis] + block, k, kRest[axis], modes[axis]);
  }
  ROBOT_TISSUE_ROLLED
  for (int i = 0; i < kLanes; ++i) least[i] = 1e30F;
  for (int corner = 0; corner < kCorners; ++corner) {
    const float sign[3] = {(corner & 1) != 0 ? -1.0F : 1.0F, (corner & 2) != 0 ? -1.0F : 1.0F,
                           (corner & 4) != 0 ? -1.0F : 1.0F};
    for (int axis = 0; axis < 3; ++axis) edgesAt(modes[axis], sign, edges[axis]);
    for (int i = 0; i < kLanes; ++i) {
      const float xx = edges[0][0][i], yx = edges[1][0][i], zx = edges[2][0][i];
      const float xy = edges[0][1][i], yy = edges[1][1][i], zy = edges[2][1][i];
      const float xz = edges[0][2][i], yz = edges[1][2][i], zz = edges[2][2][i];
      const float spanned =
          -(xx * (yy * zz - zy * yz) + yx * (zy * xz - xy * zz) + zx * (xy * yz - yy * xz));
      least[i] = spanned < least[i] ? spanned : least[i];
    }
  }
}

// The barrier at one corner of each cell, in its four nodes.
ROBOT_TISSUE_INLINE void addBarrierPull(const LaneArrays& lanes, const LaneGrid::Around& above,
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

}  // namespace

// All corners of a cell, with its lowest one at the slot, pushed by its energy.
ROBOT_TISSUE_LANES
void addForcesOfBlock(const LaneArrays& lanes, const LaneGrid::Around& above, int block,
                      bool squeezed, float* const force[3]) {
  Lane pull[3][kCorners];
  pullCorners(lanes, above, block, pull);
  if (squeezed) {
    for (int corner = 0; corner < kCorners; ++corner) {
      addBarrierPull(lanes, above, block, corner, pull);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < kCorners; ++k) {
      float* const to = force[axis] + block + above.corner[k];
      ROBOT_TISSUE_ROLLED
      for (int i = 0; i < kLanes; ++i) to[i] -= pull[axis][k][i];
    }
  }
}

void addSpringForces(const LaneArrays& lanes, const LaneSprings& springs, int block,
                     float* const force[3]) {
  for (int i = 0; i < kLanes; ++i) {
    const float x = lanes.moved[0][block + i];
    const float y = lanes.moved[1][block + i];
    const float z = lanes.moved[2][block + i];
    const auto& of = springs.of;
    force[0][block + i] -= of[0][i] * x + of[3][i] * y + of[4][i] * z;
    force[1][block + i] -= of[3][i] * x + of[1][i] * y + of[5][i] * z;
    force[2][block + i] -= of[4][i] * x + of[5][i] * y + of[2][i] * z;
  }
}

ROBOT_TISSUE_LANES
void squeezeOfBlock(const LaneArrays& lanes, const LaneGrid::Around& above, int block,
                    float* tightest) {
  Lane least;
  tightestCorners(lanes, above, block, least);
  ROBOT_TISSUE_ROLLED
  for (int i = 0; i < kLanes; ++i) tightest[block + i] = least[i];
}

}  // namespace robot_tissue
