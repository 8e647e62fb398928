// Vectors of 512 bits, the longest that instructions take (where they take less, the compiler
// splits them), and what cell_kernel.cpp does with them.
#pragma once

#include <cstdint>
#include <cstring>

#include "simd/vector_clones.h"

// Vectors longer than the processor's are passed between functions that are all inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace robot_tissue::vectors {

template <typename Real>
struct Vector;

template <>
struct Vector<float> {
  static constexpr int kSize = 16;
  typedef float Lanes __attribute__((vector_size(64)));
  typedef std::int32_t Bits __attribute__((vector_size(64)));
  static constexpr std::int32_t kCubeRoot = 0x54a21d2a;  // bits of 1, times 4/3; tuned
  static constexpr int kHalvings = 12;
  static constexpr int kRefinements = 3;
};

template <>
struct Vector<double> {
  static constexpr int kSize = 8;
  typedef double Lanes __attribute__((vector_size(64)));
  typedef std::int64_t Bits __attribute__((vector_size(64)));
  static constexpr std::int64_t kCubeRoot = 0x553f0a3d70a3d70a;
  static constexpr int kHalvings = 20;
  static constexpr int kRefinements = 4;
};

template <typename Real>
using Lanes = typename Vector<Real>::Lanes;

template <typename Real>
ROBOT_TISSUE_INLINE Lanes<Real> all(Real x) {
  return Lanes<Real>{} + x;
}

template <typename Real>
ROBOT_TISSUE_INLINE Lanes<Real> load(const Real* from) {
  Lanes<Real> x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

template <typename Real>
ROBOT_TISSUE_INLINE void subtract(const Lanes<Real>& x, Real* from) {
  const Lanes<Real> left = load(from) - x;
  std::memcpy(from, &left, sizeof left);
}

template <typename L>
ROBOT_TISSUE_INLINE L greater(const L& a, const L& b) {
  return a > b ? a : b;
}

// Whether any lane is true.
template <typename Mask>
ROBOT_TISSUE_INLINE bool any(const Mask& mask) {
  std::uint64_t words[8];
  std::memcpy(words, &mask, sizeof words);
  return (words[0] | words[1] | words[2] | words[3] | words[4] | words[5] | words[6] | words[7]) !=
         0;
}

// r = x^(-1/3), x > 0. A guess within some percent: the bits of x as a number are about its
// logarithm, so those of r are a constant less a third of them, 1/3 = 1/4 + 1/16 + ...; then
// Newton's method, r <- r (4 - x r^3) / 3.
template <typename Real>
ROBOT_TISSUE_INLINE Lanes<Real> inverseCubeRoot(const Lanes<Real>& x) {
  using Bits = typename Vector<Real>::Bits;
  const Bits bits_of_x = __builtin_bit_cast(Bits, x);
  Bits bits = Bits{} + Vector<Real>::kCubeRoot;
  for (int shift = 2; shift <= Vector<Real>::kHalvings; shift += 2) bits -= bits_of_x >> shift;
  Lanes<Real> root = __builtin_bit_cast(Lanes<Real>, bits);
  const Lanes<Real> third = x * Real(1.0 / 3.0);
  for (int i = 0; i < Vector<Real>::kRefinements; ++i) {
    root *= Real(4.0 / 3.0) - third * root * root * root;
  }
  return root;
}

}  // namespace robot_tissue::vectors
