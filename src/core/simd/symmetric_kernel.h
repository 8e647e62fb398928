// Loops over symmetric 3x3 matrices D, one for each node, in vector instructions; sums as those of
// field_kernel.h.
#pragma once

#include <array>
#include <cstddef>

#include "simd/numbers.h"

namespace robot_tissue {

constexpr std::size_t kSymmetric = 6;

// The numbers of one matrix, each in an array of its own: xx, yy, zz, yz, xz, xy.
template <typename Real>
using SymmetricField = std::array<Numbers<Real>, kSymmetric>;
template <typename Real>
using SymmetricPointers = std::array<Real*, kSymmetric>;
template <typename Real>
using VectorPointers = std::array<Real*, 3>;

template <typename Real>
SymmetricPointers<Real> pointersTo(SymmetricField<Real>& field, int first = 0) {
  SymmetricPointers<Real> all;
  for (std::size_t i = 0; i < kSymmetric; ++i) all[i] = field[i].data() + first;
  return all;
}

template <typename Real>
SymmetricPointers<const Real> pointersTo(const SymmetricField<Real>& field, int first = 0) {
  SymmetricPointers<const Real> all;
  for (std::size_t i = 0; i < kSymmetric; ++i) all[i] = field[i].data() + first;
  return all;
}

template <typename Real>
VectorPointers<Real> pointersTo(std::array<Numbers<Real>, 3>& field, int first = 0) {
  return {field[0].data() + first, field[1].data() + first, field[2].data() + first};
}

template <typename Real>
VectorPointers<const Real> pointersTo(const std::array<Numbers<Real>, 3>& field, int first = 0) {
  return {field[0].data() + first, field[1].data() + first, field[2].data() + first};
}

// D = below + lower.
void sumBoth(const float* below, const float* lower, float* sum, int count);
void sumBoth(const double* below, const double* lower, double* sum, int count);

// inverse = D^-1 where `free` is 1, else 0; D must be positive definite where it is 1.
void invertWhereFree(const SymmetricPointers<const float>& matrix, const float* free,
                     const SymmetricPointers<float>& inverse, int count);
void invertWhereFree(const SymmetricPointers<const double>& matrix, const double* free,
                     const SymmetricPointers<double>& inverse, int count);

// way = keep * way + share * inverse force, each component cut to `longest`; displacement += way.
template <typename Real>
struct StepAlong {
  Real keep, share, longest;
};
void stepAlong(const SymmetricPointers<const float>& inverse,
               const VectorPointers<const float>& force, const StepAlong<float>& step,
               const VectorPointers<float>& way, const VectorPointers<float>& displacement,
               int count);
void stepAlong(const SymmetricPointers<const double>& inverse,
               const VectorPointers<const double>& force, const StepAlong<double>& step,
               const VectorPointers<double>& way, const VectorPointers<double>& displacement,
               int count);

// Sum of |inverse force|^2.
double squaredProduct(const SymmetricPointers<const float>& inverse,
                      const VectorPointers<const float>& force, int count);
double squaredProduct(const SymmetricPointers<const double>& inverse,
                      const VectorPointers<const double>& force, int count);

}  // namespace robot_tissue
