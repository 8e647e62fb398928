#include "simd/symmetric_kernel.h"

#include <algorithm>

#include "simd/sum_of_terms.h"
#include "simd/vector_clones.h"

namespace robot_tissue {
namespace {

template <typename Real>
ROBOT_TISSUE_INLINE void addBoth(const Real* below, const Real* __restrict lower,
                                 Real* __restrict sum, int count) {
  for (int i = 0; i < count; ++i) sum[i] = below[i] + lower[i];
}

// By cofactors. Where `free` is 0 there may be no matrix: then that of 1.
template <typename Real>
ROBOT_TISSUE_INLINE void invertAll(const SymmetricPointers<const Real>& matrix,
                                   const Real* __restrict free,
                                   const SymmetricPointers<Real>& inverse, int count) {
  const Real *xx = matrix[0], *yy = matrix[1], *zz = matrix[2], *yz = matrix[3], *xz = matrix[4],
             *xy = matrix[5];
  Real *of_xx = inverse[0], *of_yy = inverse[1], *of_zz = inverse[2], *of_yz = inverse[3],
       *of_xz = inverse[4], *of_xy = inverse[5];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const Real more = Real(1) - free[i];
    const Real a = xx[i] + more, b = yy[i] + more, c = zz[i] + more;
    const Real d = yz[i], e = xz[i], f = xy[i];
    const Real bc = b * c - d * d, ef = e * d - f * c, fd = f * d - e * b;
    const Real share = free[i] / (a * bc + f * ef + e * fd);
    of_xx[i] = share * bc;
    of_yy[i] = share * (a * c - e * e);
    of_zz[i] = share * (a * b - f * f);
    of_yz[i] = share * (e * f - a * d);
    of_xz[i] = share * fd;
    of_xy[i] = share * ef;
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE Real goOn(Real way, Real motion, const StepAlong<Real>& step) {
  const Real next = step.keep * way + step.share * motion;
  return std::min(std::max(next, -step.longest), step.longest);
}

template <typename Real>
ROBOT_TISSUE_INLINE void stepAll(const SymmetricPointers<const Real>& inverse,
                                 const VectorPointers<const Real>& force,
                                 const StepAlong<Real>& step, const VectorPointers<Real>& way,
                                 const VectorPointers<Real>& displacement, int count) {
  const Real *xx = inverse[0], *yy = inverse[1], *zz = inverse[2], *yz = inverse[3],
             *xz = inverse[4], *xy = inverse[5];
  const Real *fx = force[0], *fy = force[1], *fz = force[2];
  Real *wx = way[0], *wy = way[1], *wz = way[2];
  Real *ux = displacement[0], *uy = displacement[1], *uz = displacement[2];
  const StepAlong<Real> by = step;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    wx[i] = goOn(wx[i], xx[i] * fx[i] + xy[i] * fy[i] + xz[i] * fz[i], by);
    wy[i] = goOn(wy[i], xy[i] * fx[i] + yy[i] * fy[i] + yz[i] * fz[i], by);
    wz[i] = goOn(wz[i], xz[i] * fx[i] + yz[i] * fy[i] + zz[i] * fz[i], by);
    ux[i] += wx[i];
    uy[i] += wy[i];
    uz[i] += wz[i];
  }
}

template <typename Real>
ROBOT_TISSUE_INLINE double squareAll(const SymmetricPointers<const Real>& inverse,
                                     const VectorPointers<const Real>& force, int count) {
  const Real *xx = inverse[0], *yy = inverse[1], *zz = inverse[2], *yz = inverse[3],
             *xz = inverse[4], *xy = inverse[5], *fx = force[0], *fy = force[1], *fz = force[2];
  return sumOfTerms<Real>(count, [=](int i) {
    const Real x = xx[i] * fx[i] + xy[i] * fy[i] + xz[i] * fz[i];
    const Real y = xy[i] * fx[i] + yy[i] * fy[i] + yz[i] * fz[i];
    const Real z = xz[i] * fx[i] + yz[i] * fy[i] + zz[i] * fz[i];
    return x * x + y * y + z * z;
  });
}

}  // namespace

ROBOT_TISSUE_CLONES void sumBoth(const float* below, const float* lower, float* sum, int count) {
  addBoth(below, lower, sum, count);
}

ROBOT_TISSUE_CLONES void sumBoth(const double* below, const double* lower, double* sum, int count) {
  addBoth(below, lower, sum, count);
}

ROBOT_TISSUE_CLONES void invertWhereFree(const SymmetricPointers<const float>& matrix,
                                         const float* free, const SymmetricPointers<float>& inverse,
                                         int count) {
  invertAll(matrix, free, inverse, count);
}

ROBOT_TISSUE_CLONES void invertWhereFree(const SymmetricPointers<const double>& matrix,
                                         const double* free,
                                         const SymmetricPointers<double>& inverse, int count) {
  invertAll(matrix, free, inverse, count);
}

ROBOT_TISSUE_CLONES void stepAlong(const SymmetricPointers<const float>& inverse,
                                   const VectorPointers<const float>& force,
                                   const StepAlong<float>& step, const VectorPointers<float>& way,
                                   const VectorPointers<float>& displacement, int count) {
  stepAll(inverse, force, step, way, displacement, count);
}

ROBOT_TISSUE_CLONES void stepAlong(const SymmetricPointers<const double>& inverse,
                                   const VectorPointers<const double>& force,
                                   const StepAlong<double>& step, const VectorPointers<double>& way,
                                   const VectorPointers<double>& displacement, int count) {
  stepAll(inverse, force, step, way, displacement, count);
}

ROBOT_TISSUE_CLONES double squaredProduct(const SymmetricPointers<const float>& inverse,
                                          const VectorPointers<const float>& force, int count) {
  return squareAll(inverse, force, count);
}

ROBOT_TISSUE_CLONES double squaredProduct(const SymmetricPointers<const double>& inverse,
                                          const VectorPointers<const double>& force, int count) {
  return squareAll(inverse, force, count);
}

}  // namespace robot_tissue
