// Vectors as long as the processor's, and what cell_kernel.cpp does with them. The compiler would
// split longer ones, but compares and blends these number by number: that took half of the time.
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

// exp(x), 0 <= x <= 80: with n the whole number next to x / ln 2 and r = x - n ln 2, 2^n times
// Taylor's polynomial in r. Adding 1.5 * 2^digits rounds to n and leaves it in the lowest bits.
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

}  // namespace robot_tissue::vectors
