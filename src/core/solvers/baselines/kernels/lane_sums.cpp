// Kernels over whole arrays.
#include "solvers/baselines/kernels/lane_kernels.h"
#include "solvers/baselines/kernels/lane_math.h"

namespace robot_tissue {

ROBOT_TISSUE_CLONES
double squaredProduct(const float* a, const float* b, const float* c, int count) {
  constexpr int kBlocks = 64;  // summed in single precision
  double total = 0.0;
  for (int first = 0; first < count; first += kBlocks * kLanes) {
    const int end = first + kBlocks * kLanes < count ? first + kBlocks * kLanes : count;
    Lane sum = {};
    for (int block = first; block < end; block += kLanes) {
      ROBOT_TISSUE_ROLLED
      for (int i = 0; i < kLanes; ++i) {
        const float product = a[block + i] * b[block + i] * c[block + i];
        sum[i] += product * product;
      }
    }
    for (const float part : sum) total += static_cast<double>(part);
  }
  return total;
}

ROBOT_TISSUE_CLONES
void coast(float keep, int count, const float* free, float* before, float* moved) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float now = moved[i];
    moved[i] = now + keep * free[i] * (now - before[i]);
    before[i] = now;
  }
}

ROBOT_TISSUE_CLONES
void extrapolate(float share, int count, float* moved, float* last, float* before) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float now = before[i] + share * (moved[i] - before[i]);
    before[i] = last[i];
    last[i] = now;
    moved[i] = now;
  }
}

ROBOT_TISSUE_CLONES
void addQuotient(int count, const float* moved, const float* force, const float* softness,
                 const float* free, float* from, float* from_force, QuotientSums& sums) {
  constexpr int kBlocks = 64;  // summed in single precision
  for (int first = 0; first < count; first += kBlocks * kLanes) {
    const int end = first + kBlocks * kLanes < count ? first + kBlocks * kLanes : count;
    Lane work = {}, mass = {};
    for (int block = first; block < end; block += kLanes) {
#pragma GCC ivdep
      ROBOT_TISSUE_ROLLED
      for (int i = block; i < block + kLanes; ++i) {
        const float motion = (moved[i] - from[i]) * free[i];
        const float soft = softness[i];
        work[i - block] += motion * (from_force[i] - force[i]);
        mass[i - block] += soft > 0.0F ? motion * motion / soft : 0.0F;
        from[i] = moved[i];
        from_force[i] = force[i];
      }
    }
    for (int i = 0; i < kLanes; ++i) {
      sums.work += static_cast<double>(work[i]);
      sums.mass += static_cast<double>(mass[i]);
    }
  }
}

ROBOT_TISSUE_CLONES
void roll(float keep, float push, float most, int count, const float* force, const float* softness,
          const float* free, float* last, float* velocity, float* moved, QuotientSums& sums) {
  constexpr int kBlocks = 64;  // summed in single precision
  for (int first = 0; first < count; first += kBlocks * kLanes) {
    const int end = first + kBlocks * kLanes < count ? first + kBlocks * kLanes : count;
    Lane work = {}, mass = {};
    for (int block = first; block < end; block += kLanes) {
#pragma GCC ivdep
      ROBOT_TISSUE_ROLLED
      for (int i = block; i < block + kLanes; ++i) {
        const float before = velocity[i];
        const float soft = softness[i];
        work[i - block] += before * (last[i] - force[i]);
        mass[i - block] += soft > 0.0F ? before * before / soft : 0.0F;
        const float pushed = keep * before + push * soft * force[i] * free[i];
        const float lower = pushed < most ? pushed : most;
        const float now = lower > -most ? lower : -most;
        last[i] = force[i];
        velocity[i] = now;
        moved[i] += now;
      }
    }
    for (int i = 0; i < kLanes; ++i) {
      sums.work += static_cast<double>(work[i]);
      sums.mass += static_cast<double>(mass[i]);
    }
  }
}

}  // namespace robot_tissue
