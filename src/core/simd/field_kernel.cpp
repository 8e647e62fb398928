#include "simd/field_kernel.h"

#include <algorithm>
#include <cmath>

#include "simd/sum_of_terms.h"
#include "simd/vector_clones.h"

namespace robot_tissue {
namespace {

template <typename Real>
ROBOT_TISSUE_INLINE void sumAll(const Real* __restrict below, const Real* __restrict lower,
                                const Real* __restrict load, const Real* __restrict free,
                                Real* __restrict whole, Real* __restrict force, int count) {
  for (int i = 0; i < count; ++i) {
    const Real sum = below[i] + lower[i] + load[i];
    whole[i] = sum;
    force[i] = free[i] != Real(0) ? sum : Real(0);
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE void takeFree(const Real* __restrict whole, const Real* __restrict free,
                                  Real* __restrict force, int count) {
  for (int i = 0; i < count; ++i) force[i] = free[i] != Real(0) ? whole[i] : Real(0);
}

template <typename Real>
ROBOT_TISSUE_INLINE void holdAll(const Real* __restrict stiffness,
                                 const Real* __restrict displacement, const Real* __restrict free,
                                 Real* __restrict whole, Real* __restrict force, int count) {
  for (int i = 0; i < count; ++i) {
    whole[i] -= stiffness[i] * displacement[i];
    force[i] = free[i] * whole[i];
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE void loadAll(const Real* __restrict wanted, const Real* __restrict free,
                                 Real* __restrict load, Real* __restrict force, int count) {
  for (int i = 0; i < count; ++i) {
    const Real change = free[i] * (wanted[i] - force[i]);
    load[i] += change;
    force[i] += change;
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE void loadAllInstead(const Real* __restrict wanted, const Real* __restrict known,
                                        const Real* __restrict free, Real* __restrict load,
                                        Real* __restrict force, int count) {
  for (int i = 0; i < count; ++i) {
    const Real change = free[i] * (wanted[i] - known[i]);
    load[i] += change;
    force[i] += change;
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE void addFree(const Real* __restrict motion, const Real* __restrict free,
                                 Real share, Real* __restrict to, int count) {
  for (int i = 0; i < count; ++i) to[i] += free[i] * share * motion[i];
}

template <typename Real>
ROBOT_TISSUE_INLINE void addAll(const Real* __restrict other, Real share, Real* __restrict to,
                                int count) {
  for (int i = 0; i < count; ++i) to[i] += share * other[i];
}

template <typename Real>
ROBOT_TISSUE_INLINE void subtractAll(const Real* __restrict a, const Real* __restrict b, Real share,
                                     Real* __restrict difference, int count) {
  for (int i = 0; i < count; ++i) difference[i] = share * (a[i] - b[i]);
}

template <typename Real>
ROBOT_TISSUE_INLINE void meanAll(const Real* __restrict a, const Real* __restrict b,
                                 Real* __restrict mean, int count) {
  for (int i = 0; i < count; ++i) mean[i] = Real(0.5) * (a[i] + b[i]);
}

template <typename Real>
ROBOT_TISSUE_INLINE void prolongAll(const Real* __restrict coarse, Real* __restrict fine,
                                    int count) {
  for (int i = 0; i < count / 2; ++i) {
    fine[2 * i] = coarse[i];
    fine[2 * i + 1] = Real(0.5) * (coarse[i] + coarse[i + 1]);
  }
  if (count % 2 != 0) fine[count - 1] = coarse[count / 2];
}

template <typename Real>
ROBOT_TISSUE_INLINE void restrictAll(const Real* __restrict fine, Real* __restrict coarse,
                                     int count) {
  for (int i = 0; i < count; ++i) {
    coarse[i] = fine[2 * i + 1] + Real(0.5) * (fine[2 * i] + fine[2 * i + 2]);
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE void halveAll(const Real* __restrict fine, Real* __restrict coarse, int count) {
  for (int i = 0; i < count; ++i) coarse[i] = Real(0.5) * fine[2 * i];
}

template <typename Real>
ROBOT_TISSUE_INLINE double dotAll(const Real* a, const Real* b, int count) {
  return sumOfTerms<Real>(count, [=](int i) { return a[i] * b[i]; });
}

template <typename Real>
ROBOT_TISSUE_INLINE double distanceAll(const Real* a, const Real* b, int count) {
  return sumOfTerms<Real>(count, [=](int i) { return (a[i] - b[i]) * (a[i] - b[i]); });
}

template <typename Real>
ROBOT_TISSUE_INLINE double greatestOfAll(const Real* values, int count) {
  constexpr int kPartialSums = 32;
  Real lanes[kPartialSums] = {};
  int i = 0;
  for (; i + kPartialSums <= count; i += kPartialSums) {
    for (int lane = 0; lane < kPartialSums; ++lane) {
      const Real size = std::abs(values[i + lane]);
      lanes[lane] = size > lanes[lane] ? size : lanes[lane];
    }
  }
  Real greatest = 0;
  for (const Real lane : lanes) greatest = std::max(greatest, lane);
  for (; i < count; ++i) greatest = std::max(greatest, std::abs(values[i]));
  return static_cast<double>(greatest);
}

}  // namespace

ROBOT_TISSUE_CLONES void sumForces(const float* below, const float* lower, const float* load,
                                   const float* free, float* whole, float* force, int count) {
  sumAll(below, lower, load, free, whole, force, count);
}

ROBOT_TISSUE_CLONES void sumForces(const double* below, const double* lower, const double* load,
                                   const double* free, double* whole, double* force, int count) {
  sumAll(below, lower, load, free, whole, force, count);
}

ROBOT_TISSUE_CLONES void takeWhereFree(const float* whole, const float* free, float* force,
                                       int count) {
  takeFree(whole, free, force, count);
}

ROBOT_TISSUE_CLONES void takeWhereFree(const double* whole, const double* free, double* force,
                                       int count) {
  takeFree(whole, free, force, count);
}

ROBOT_TISSUE_CLONES void addHolds(const float* stiffness, const float* displacement,
                                  const float* free, float* whole, float* force, int count) {
  holdAll(stiffness, displacement, free, whole, force, count);
}

ROBOT_TISSUE_CLONES void addHolds(const double* stiffness, const double* displacement,
                                  const double* free, double* whole, double* force, int count) {
  holdAll(stiffness, displacement, free, whole, force, count);
}

ROBOT_TISSUE_CLONES void fasRightHandSide(const float* wanted, const float* free, float* load,
                                          float* force, int count) {
  loadAll(wanted, free, load, force, count);
}

ROBOT_TISSUE_CLONES void fasRightHandSide(const double* wanted, const double* free, double* load,
                                          double* force, int count) {
  loadAll(wanted, free, load, force, count);
}

ROBOT_TISSUE_CLONES void fasRightHandSideBeside(const float* wanted, const float* known,
                                                const float* free, float* load, float* force,
                                                int count) {
  loadAllInstead(wanted, known, free, load, force, count);
}

ROBOT_TISSUE_CLONES void fasRightHandSideBeside(const double* wanted, const double* known,
                                                const double* free, double* load, double* force,
                                                int count) {
  loadAllInstead(wanted, known, free, load, force, count);
}

ROBOT_TISSUE_CLONES void addWhereFree(const float* motion, const float* free, float share,
                                      float* to, int count) {
  addFree(motion, free, share, to, count);
}

ROBOT_TISSUE_CLONES void addWhereFree(const double* motion, const double* free, double share,
                                      double* to, int count) {
  addFree(motion, free, share, to, count);
}

ROBOT_TISSUE_CLONES void addShare(const float* other, float share, float* to, int count) {
  addAll(other, share, to, count);
}

ROBOT_TISSUE_CLONES void addShare(const double* other, double share, double* to, int count) {
  addAll(other, share, to, count);
}

ROBOT_TISSUE_CLONES void subtract(const float* a, const float* b, float share, float* difference,
                                  int count) {
  subtractAll(a, b, share, difference, count);
}

ROBOT_TISSUE_CLONES void subtract(const double* a, const double* b, double share,
                                  double* difference, int count) {
  subtractAll(a, b, share, difference, count);
}

ROBOT_TISSUE_CLONES void meanOf(const float* a, const float* b, float* mean, int count) {
  meanAll(a, b, mean, count);
}

ROBOT_TISSUE_CLONES void meanOf(const double* a, const double* b, double* mean, int count) {
  meanAll(a, b, mean, count);
}

ROBOT_TISSUE_CLONES void prolongRow(const float* coarse, float* fine, int count) {
  prolongAll(coarse, fine, count);
}

ROBOT_TISSUE_CLONES void prolongRow(const double* coarse, double* fine, int count) {
  prolongAll(coarse, fine, count);
}

ROBOT_TISSUE_CLONES void restrictRow(const float* fine, float* coarse, int count) {
  restrictAll(fine, coarse, count);
}

ROBOT_TISSUE_CLONES void restrictRow(const double* fine, double* coarse, int count) {
  restrictAll(fine, coarse, count);
}

ROBOT_TISSUE_CLONES void injectRow(const float* fine, float* coarse, int count) {
  halveAll(fine, coarse, count);
}

ROBOT_TISSUE_CLONES void injectRow(const double* fine, double* coarse, int count) {
  halveAll(fine, coarse, count);
}

ROBOT_TISSUE_CLONES double dotOf(const float* a, const float* b, int count) {
  return dotAll(a, b, count);
}

ROBOT_TISSUE_CLONES double dotOf(const double* a, const double* b, int count) {
  return dotAll(a, b, count);
}

ROBOT_TISSUE_CLONES double squaredDistance(const float* a, const float* b, int count) {
  return distanceAll(a, b, count);
}

ROBOT_TISSUE_CLONES double squaredDistance(const double* a, const double* b, int count) {
  return distanceAll(a, b, count);
}

ROBOT_TISSUE_CLONES double sumOf(const float* values, int count) {
  return sumOfTerms<float>(count, [=](int i) { return values[i]; });
}

ROBOT_TISSUE_CLONES double greatestOf(const float* values, int count) {
  return greatestOfAll(values, count);
}

ROBOT_TISSUE_CLONES double sumOf(const double* values, int count) {
  return sumOfTerms<double>(count, [=](int i) { return values[i]; });
}

ROBOT_TISSUE_CLONES double greatestOf(const double* values, int count) {
  return greatestOfAll(values, count);
}

}  // namespace robot_tissue
