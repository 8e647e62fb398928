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

// Twice the density of what resists a change of shape, mu (J^(-2/3) I1 - 3), small ones not rounded
// off; `a` as in Stiffening.
ROBOT_TISSUE_INLINE float shapeEnergyOf(float shear, const Strain& strain, float a) {
  const float growth = strain.growth, volume = 1.0F + growth;
  const float from = volume > kFlattest ? volume : kFlattest;
  const float root = inverseCubeRoot(from);
  const float r = from * root;  // J^(2/3)
  const float lean =
      shear * root * root * (strain.excess - 3.0F * growth * (2.0F + growth) / (r * r + r + 1.0F));
  return volume > kFlattest ? lean : a * (3.0F + strain.excess) - 3.0F * shear;
}

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
    const Strain strain = strainOf(mx, my, mz, kFromLowest);
    mx.x -= 1.0F;
    my.y -= 1.0F;
    mz.z -= 1.0F;
    const float volume = 1.0F + strain.growth, invariant = 3.0F + strain.excess;
    Stiffening s = stiffeningOf(shears[i], volume);
    float energy = shapeEnergyOf(shears[i], strain, s.a);
    if constexpr (kStiffens) {
      const float of_shape = shapeStrainOf(strain, stiffeningOf(1.0F, volume).a);
      const StrainStiffening g = strainStiffeningOf(lanes.stiffening[block + i], of_shape);
      energy = shears[i] * g.value;
      s.a *= g.slope;
      s.slope *= g.slope;
    }
    cells.energy[i] = energy > 0.0F ? energy : 0.0F;
    const float firm = std::sqrt(bulks[i]);
    cells.volume[i] = firm * strain.growth;
    const Cofactors by = cofactorsOf(mx, my, mz);
    spreadAll(mx, my, mz, s.a, -0.5F * s.slope * invariant, by, cells.shape_pull, i);
    const auto alone = [firm](const Vector& v) -> Modes {
      return {-firm * v.x, -firm * v.y, -firm * v.z, 0.0F, 0.0F, 0.0F, 0.0F};
    };
    spread(alone(by.of_x), cells.volume_pull[0], i);
    spread(alone(by.of_y), cells.volume_pull[1], i);
    spread(alone(by.of_z), cells.volume_pull[2], i);
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

// How far the corners go along the two constraints' gradients, so that both are met at once: the
// first one is the root of the energy, whose gradient is half that of the energy over it.
ROBOT_TISSUE_INLINE void solvePair(const CellConstraints& cells, const Answers& answers,
                                   Lane& by_shape, Lane& by_volume) {
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
  solvePair(cells, answers, by_shape, by_volume);
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
