// Vectors as long as the processor's, and what kernels of cells and membranes do with them. The
// compiler would split longer ones, but compares and blends these number by number: that took half
// of the time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "robot_tissue/core/compat.h"
#include "simd/vector_clones.h"

// Vectors longer than the processor's are passed between functions that are all inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace robot_tissue::vectors {

// Of kBytes in all.
template <typename Number, int kBytes>
struct Vector;

template <int kBytes>
struct Vector<float, kBytes> {
  using Real = float;
  static constexpr int kSize = kBytes / sizeof(float);
  typedef float Lanes __attribute__((vector_size(kBytes)));
  typedef std::int32_t Bits __attribute__((vector_size(kBytes)));
  static constexpr std::int32_t kCubeRoot = 0x54a21d2a;  // bits of 1, times 4/3; tuned
  static constexpr int kHalvings = 12;
  static constexpr int kRefinements = 3;
  static constexpr int kDigits = 23;  // of the mantissa
  static constexpr float kLn2High = 0.693145751953125F, kLn2Low = 1.42860677e-6F;
  static constexpr int kExponentialTerms = 7;
};

template <int kBytes>
struct Vector<double, kBytes> {
  using Real = double;
  static constexpr int kSize = kBytes / sizeof(double);
  typedef double Lanes __attribute__((vector_size(kBytes)));
  typedef std::int64_t Bits __attribute__((vector_size(kBytes)));
  static constexpr std::int64_t kCubeRoot = 0x553f0a3d70a3d70a;
  static constexpr int kHalvings = 20;
  static constexpr int kRefinements = 4;
  static constexpr int kDigits = 52;
  static constexpr double kLn2High = 0.693147180369123816490, kLn2Low = 1.90821492927058770002e-10;
  static constexpr int kExponentialTerms = 13;
};

template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes all(typename V::Real x) {
  return typename V::Lanes{} + x;
}

template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes load(const typename V::Real* from) {
  typename V::Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

// {0, x[0], x[1], ...}
template <typename L, std::size_t... kIndex>
ROBOT_TISSUE_INLINE L oneLaneUp(const L& x, std::index_sequence<kIndex...>) {
#if ROBOT_TISSUE_HAS_SHUFFLEVECTOR
  constexpr int kSize = sizeof...(kIndex);
  return __builtin_shufflevector(x, L{}, (kIndex == 0 ? kSize : static_cast<int>(kIndex) - 1)...);
#else
  return L{(kIndex == 0 ? 0 : x[kIndex == 0 ? 0 : kIndex - 1])...};
#endif
}

// Subtracts `low`, and `high` one place further on, which is subtracted first. In one go: a load
// would wait for a store that it overlaps.
template <typename V>
ROBOT_TISSUE_INLINE void subtractBoth(const typename V::Lanes& low, const typename V::Lanes& high,
                                      typename V::Real* from) {
  from[V::kSize] -= high[V::kSize - 1];
  const typename V::Lanes left =
      load<V>(from) - oneLaneUp(high, std::make_index_sequence<V::kSize>()) - low;
  std::memcpy(from, &left, sizeof left);
}

template <typename L>
ROBOT_TISSUE_INLINE L greater(const L& a, const L& b) {
  return a > b ? a : b;
}

template <typename L>
ROBOT_TISSUE_INLINE L lesser(const L& a, const L& b) {
  return a < b ? a : b;
}

// Whether any lane is above 0; none is below, or -0. Of numbers: GCC 12 makes masks lane by lane.
template <typename L>
ROBOT_TISSUE_INLINE bool anyAbove0(const L& x) {
  typedef std::uint64_t Words __attribute__((vector_size(16)));
  Words words[sizeof x / sizeof(Words)];
  std::memcpy(words, &x, sizeof words);
  Words all_of_them{};
  for (const Words& some : words) all_of_them |= some;
  return (all_of_them[0] | all_of_them[1]) != 0;
}

// r = x^(-1/3), x > 0. A guess within some percent: the bits of x as a number are about its
// logarithm, so those of r are a constant less a third of them, 1/3 = 1/4 + 1/16 + ...; then
// Newton's method, r <- r (4 - x r^3) / 3.
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes inverseCubeRoot(const typename V::Lanes& x) {
  using Real = typename V::Real;
  using Bits = typename V::Bits;
  const Bits bits_of_x = __builtin_bit_cast(Bits, x);
  Bits bits = Bits{} + V::kCubeRoot;
  for (int shift = 2; shift <= V::kHalvings; shift += 2) bits -= bits_of_x >> shift;
  typename V::Lanes root = __builtin_bit_cast(typename V::Lanes, bits);
  const typename V::Lanes third = x * Real(1.0 / 3.0);
  for (int i = 0; i < V::kRefinements; ++i) {
    root *= Real(4.0 / 3.0) - third * root * root * root;
  }
  return root;
}

// exp(x), |x| <= 80 (700 in double precision): with n the whole number next to x / ln 2 and r = x -
// n ln 2, 2^n times Taylor's polynomial in r. Adding 1.5 * 2^digits rounds to n and leaves it in
// the lowest bits.
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes exponential(const typename V::Lanes& x) {
  using Real = typename V::Real;
  using Bits = typename V::Bits;
  constexpr Real kRounder = Real(3LL << (V::kDigits - 1));
  const typename V::Lanes rounded = x * Real(1.44269504088896340736) + kRounder;
  const typename V::Lanes n = rounded - kRounder;
  const typename V::Lanes r = (x - n * V::kLn2High) - n * V::kLn2Low;
  typename V::Lanes sum = all<V>(Real(1));
#pragma GCC unroll 13
  for (int term = V::kExponentialTerms; term > 0; --term) {
    sum = Real(1) + r * sum * (Real(1) / Real(term));
  }
  const Bits power =
      (__builtin_bit_cast(Bits, rounded) << V::kDigits) + __builtin_bit_cast(Bits, all<V>(Real(1)));
  return sum * __builtin_bit_cast(typename V::Lanes, power);
}

// ln(x), x > 0; double precision. With x = 2^n m, 1 / sqrt(2) <= m < sqrt(2), and f = (m - 1) / (m
// + 1): n ln 2 + 2 (f + f^3 / 3 + f^5 / 5 + ...).
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes logarithm(const typename V::Lanes& x) {
  using L = typename V::Lanes;
  using Bits = typename V::Bits;
  constexpr std::int64_t kRootOfHalf = 0x3fe6a09e667f3bcd;
  constexpr int kTerms = 12;
  // From bits, which shift by whole powers: a number near 2^n has those of n above kRootOfHalf's.
  const Bits above = __builtin_bit_cast(Bits, x) - kRootOfHalf;
  const Bits power = above >> V::kDigits;
  const L m = __builtin_bit_cast(L, __builtin_bit_cast(Bits, x) - (power << V::kDigits));
  const L n = __builtin_convertvector(power, L);
  const L f = (m - 1.0) / (m + 1.0), square = f * f;
  L sum = all<V>(1.0 / (2.0 * kTerms + 1.0));
#pragma GCC unroll 12
  for (int term = kTerms - 1; term >= 0; --term) sum = 1.0 / (2.0 * term + 1.0) + square * sum;
  return n * V::kLn2High + (n * V::kLn2Low + 2.0 * f * sum);
}

// The angle of (x, y) from the axis x, -pi to pi; double precision. Of the quotient q <= 1 of both
// sizes atan q = pi / 4 + atan((q - 1) / (q + 1)); near 0 by a quotient of polynomials (Moshier
// 1989, Cephes).
template <typename V>
ROBOT_TISSUE_INLINE typename V::Lanes angleOf(const typename V::Lanes& y,
                                              const typename V::Lanes& x) {
  using L = typename V::Lanes;
  constexpr double kHalfPi = 1.57079632679489661923;
  const L high = x < 0.0 ? -x : x, wide = y < 0.0 ? -y : y;
  const L q = lesser(high, wide) / greater(high, wide);
  const L r = q > 0.66 ? (q - 1.0) / (q + 1.0) : q;
  const L z = r * r;
  const L above = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z -
                    7.500855792314704667340e1) *
                       z -
                   1.228866684490136173410e2) *
                      z -
                  6.485021904942025371773e1;
  const L below = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z +
                    4.328810604912902668951e2) *
                       z +
                   4.853903996359136964868e2) *
                      z +
                  1.945506571482613964425e2;
  const L near = r + r * z * above / below;
  const L eighth = q > 0.66 ? 0.5 * kHalfPi + near : near;
  const L quarter = wide > high ? kHalfPi - eighth : eighth;
  const L half = x < 0.0 ? 2.0 * kHalfPi - quarter : quarter;
  return y < 0.0 ? -half : half;
}

}  // namespace robot_tissue::vectors
