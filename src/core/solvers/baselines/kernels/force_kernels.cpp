// Kernels that look at cells.
#include "solvers/baselines/kernels/lane_corners.h"
#include "solvers/baselines/kernels/lane_kernels.h"
#include "solvers/baselines/kernels/lane_math.h"

namespace robot_tissue {
namespace {

// As CellModes sees a cell from its lowest corner: side_ and hand_ are -1.
template <bool kStiffens>
ROBOT_TISSUE_INLINE void pullCorners(const SoaArrays& lanes, const ColoredLayout::Around& above,
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
    Strain strain{};
    if constexpr (kStiffens) strain = strainOf(mx, my, mz, kFromLowest);
    mx.x -= 1.0F;
    my.y -= 1.0F;
    mz.z -= 1.0F;
    const float invariant = invariantOf(mx, my, mz);
    const Cofactors by = cofactorsOf(mx, my, mz);
    const float volume = -(mx.x * by.of_x.x + my.x * by.of_y.x + mz.x * by.of_z.x);
    Stiffening s = stiffeningOf(shears[i], volume);
    if constexpr (kStiffens) {
      const float w = stiffeningOf(1.0F, volume).a;
      const float slope =
          strainStiffeningOf(lanes.stiffening[block + i], shapeStrainOf(strain, w)).slope;
      s.a *= slope;
      s.slope *= slope;
    }
    const float p = -(0.5F * s.slope * invariant + bulks[i] * (volume - 1.0F));
    spreadAll(mx, my, mz, s.a, p, by, pull, i);
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

ROBOT_TISSUE_INLINE void tightestCorners(const SoaArrays& lanes, const ColoredLayout::Around& above,
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

}  // namespace

// All corners of a cell, with its lowest one at the slot, pushed by its energy.
ROBOT_TISSUE_CLONES
void addForcesOfBlock(const SoaArrays& lanes, const ColoredLayout::Around& above, int block,
                      bool squeezed, float* const force[3]) {
  Lane pull[3][kCorners];
  if (lanes.stiffening == nullptr) {
    pullCorners<false>(lanes, above, block, pull);
  } else {
    pullCorners<true>(lanes, above, block, pull);
  }
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

void addSpringForces(const SoaArrays& lanes, const SoaSprings& springs, int block,
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

ROBOT_TISSUE_CLONES
void squeezeOfBlock(const SoaArrays& lanes, const ColoredLayout::Around& above, int block,
                    float* tightest) {
  Lane least;
  tightestCorners(lanes, above, block, least);
  ROBOT_TISSUE_ROLLED
  for (int i = 0; i < kLanes; ++i) tightest[block + i] = least[i];
}

}  // namespace robot_tissue
