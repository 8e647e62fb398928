// Kernel of method `xpbd`: cells as constraints.
#include <cmath>

#include "solvers/baselines/kernels/lane_corners.h"
#include "solvers/baselines/kernels/lane_kernels.h"
#include "solvers/baselines/kernels/lane_math.h"

namespace robot_tissue {
namespace {

constexpr float kLeastEnergy = 1e-20F;  // density below which a cell has no shape to mend

// Per cell: its two constraints, their gradients in the corners. The first one's gradient is that
// of its energy; over the constraint it is the constraint's.
struct CellConstraints {
  Lane energy;  // twice the density of what resists a change of shape, and of the barrier
  Lane volume;  // second constraint
  Lane shape_pull[3][kCorners];
  Lane volume_pull[3][kCorners];
};

template <bool kStiffens>
ROBOT_TISSUE_INLINE void measure(const SoaArrays& lanes, const ColoredLayout::Around& above,
                                 int block, CellConstraints& cells) {
  const float* const x = lanes.moved[0] + block;
  const float* const y = lanes.moved[1] + block;
  const float* const z = lanes.moved[2] + block;
  const float* const shears = lanes.shear + block;
  const float* const bulks = lanes.bulk + block;
  int k[kCorners];
  for (int corner = 0; corner < kCorners; ++corner) k[corner] = above.corner[corner];
  for (int i = 0; i < kLanes; ++i) {
    Modes mx = cellModes(x, k, i), my = cellModes(y, k, i), mz = cellModes(z, k, i);
    // J - 1 and I1 - 3 from the displacement's gradient, so that small ones are not rounded off.
    const float trace = -(mx.x + my.y + mz.z);
    const float minors =
        mx.x * my.y - mx.y * my.x + my.y * mz.z - my.z * mz.y + mx.x * mz.z - mx.z * mz.x;
    const float cube = mx.x * (my.y * mz.z - my.z * mz.y) + mx.y * (my.z * mz.x - my.x * mz.z) +
                       mx.z * (my.x * mz.y - my.y * mz.x);
    const float growth = trace + minors - cube;
    const float excess = 2.0F * trace + invariantOf(mx, my, mz);
    mx.x -= 1.0F;
    my.y -= 1.0F;
    mz.z -= 1.0F;
    const float volume = 1.0F + growth, invariant = 3.0F + excess;
    Stiffening s = stiffeningOf(shears[i], volume);
    const float from = volume > kFlattest ? volume : kFlattest;
    const float root = inverseCubeRoot(from);
    const float r = from * root;  // J^(2/3)
    const float lean =
        shears[i] * root * root * (excess - 3.0F * growth * (2.0F + growth) / (r * r + r + 1.0F));
    float energy = volume > kFlattest ? lean : s.a * invariant - 3.0F * shears[i];
    if constexpr (kStiffens) {
      const float strain = shapeStrainOf({growth, excess}, stiffeningOf(1.0F, volume).a);
      const StrainStiffening g = strainStiffeningOf(lanes.stiffening[block + i], strain);
      energy = shears[i] * g.value;
      s.a *= g.slope;
      s.slope *= g.slope;
    }
    cells.energy[i] = energy > 0.0F ? energy : 0.0F;
    const float firm = std::sqrt(bulks[i]);
    cells.volume[i] = firm * growth;
    const float xx = my.y * mz.z - mz.y * my.z, xy = mz.y * mx.z - mx.y * mz.z;
    const float xz = mx.y * my.z - my.y * mx.z;
    const float yx = my.z * mz.x - mz.z * my.x, yy = mz.z * mx.x - mx.z * mz.x;
    const float yz = mx.z * my.x - my.z * mx.x;
    const float zx = my.x * mz.y - mz.x * my.y, zy = mz.x * mx.y - mx.x * mz.y;
    const float zz = mx.x * my.y - my.x * mx.y;
    const float p = -0.5F * s.slope * invariant;
    spread(gradientModes(mx, s.a, p * xx, p * yx, p * zx), cells.shape_pull[0], i);
    spread(gradientModes(my, s.a, p * xy, p * yy, p * zy), cells.shape_pull[1], i);
    spread(gradientModes(mz, s.a, p * xz, p * yz, p * zz), cells.shape_pull[2], i);
    spread({-firm * xx, -firm * yx, -firm * zx, 0.0F, 0.0F, 0.0F, 0.0F}, cells.volume_pull[0], i);
    spread({-firm * xy, -firm * yy, -firm * zy, 0.0F, 0.0F, 0.0F, 0.0F}, cells.volume_pull[1], i);
    spread({-firm * xz, -firm * yz, -firm * zz, 0.0F, 0.0F, 0.0F, 0.0F}, cells.volume_pull[2], i);
  }
}

// How far the corners give way to each constraint, and to both.
struct Answers {
  Lane shape = {}, both = {}, volume = {};
  Lane shape_rate = {}, volume_rate = {};  // what damping adds to the constraints
};

ROBOT_TISSUE_INLINE void addAnswers(const float* const mobility[3], int block,
                                    const ColoredLayout::Around& above,
                                    const CellConstraints& cells, Answers& answers) {
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const float* const mobile = mobility[axis] + block + above.corner[corner];
      ROBOT_TISSUE_ROLLED
      for (int i = 0; i < kLanes; ++i) {
        const float shape = cells.shape_pull[axis][corner][i];
        const float volume = cells.volume_pull[axis][corner][i];
        answers.shape[i] += mobile[i] * shape * shape;
        answers.both[i] += mobile[i] * shape * volume;
        answers.volume[i] += mobile[i] * volume * volume;
      }
    }
  }
}

// XPBD, equation 26: with the share y of the damping time over the step, y g (x - before) joins the
// constraint, and the answers count (1 + y) times.
ROBOT_TISSUE_INLINE void damp(const SoaArrays& lanes, const SoaDamping& damping, int block,
                              const ColoredLayout::Around& above, const CellConstraints& cells,
                              Answers& answers) {
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const float* const moved = lanes.moved[axis] + block + above.corner[corner];
      const float* const before = damping.before[axis] + block + above.corner[corner];
      ROBOT_TISSUE_ROLLED
      for (int i = 0; i < kLanes; ++i) {
        const float way = damping.share * (moved[i] - before[i]);
        answers.shape_rate[i] += cells.shape_pull[axis][corner][i] * way;
        answers.volume_rate[i] += cells.volume_pull[axis][corner][i] * way;
      }
    }
  }
  for (int i = 0; i < kLanes; ++i) {
    answers.shape[i] *= 1.0F + damping.share;
    answers.both[i] *= 1.0F + damping.share;
    answers.volume[i] *= 1.0F + damping.share;
  }
}

}  // namespace

ROBOT_TISSUE_CLONES
void projectBlock(const SoaArrays& lanes, const float* const mobility[3],
                  const ColoredLayout::Around& above, int block, bool squeezed,
                  const SoaDamping* damping) {
  CellConstraints cells;
  Answers answers;
  if (lanes.stiffening == nullptr) {
    measure<false>(lanes, above, block, cells);
  } else {
    measure<true>(lanes, above, block, cells);
  }
  if (squeezed) {
    for (int corner = 0; corner < kCorners; ++corner) {
      addBarrierPull(lanes, above, block, corner, cells.shape_pull);
      addBarrierEnergy(lanes, above, block, corner, cells.energy);
    }
  }
  addAnswers(mobility, block, above, cells, answers);
  if (damping != nullptr) damp(lanes, *damping, block, above, cells, answers);
  Lane by_shape, by_volume;
  for (int i = 0; i < kLanes; ++i) {
    const float root = std::sqrt(cells.energy[i]);
    const float over = cells.energy[i] > kLeastEnergy ? 1.0F / root : 0.0F;
    const float shape = root + over * answers.shape_rate[i];
    const float volume = cells.volume[i] + answers.volume_rate[i];
    const float a = answers.shape[i] * over * over + 1.0F, b = answers.both[i] * over;
    const float c = answers.volume[i] + 1.0F;
    const float by = -1.0F / (a * c - b * b);
    by_shape[i] = over * by * (c * shape - b * volume);
    by_volume[i] = by * (a * volume - b * shape);
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const float* const mobile = mobility[axis] + block + above.corner[corner];
      float* const moved = lanes.moved[axis] + block + above.corner[corner];
#pragma GCC ivdep
      ROBOT_TISSUE_ROLLED
      for (int i = 0; i < kLanes; ++i) {
        moved[i] += mobile[i] * (by_shape[i] * cells.shape_pull[axis][corner][i] +
                                 by_volume[i] * cells.volume_pull[axis][corner][i]);
      }
    }
  }
}

}  // namespace robot_tissue
