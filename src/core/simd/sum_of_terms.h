// Sums that have the same bits for any length of the processor's vectors.
#pragma once

#include <algorithm>

#include "simd/vector_clones.h"

namespace robot_tissue {

// Sum of term(i) over i < count, in runs of kRun terms: each run has kPartialSums partial sums, of
// every kPartialSums-th term, that are added at its end in double precision.
template <typename Real, typename Term>
ROBOT_TISSUE_INLINE double sumOfTerms(int count, Term term) {
  constexpr int kRun = 2048, kPartialSums = 32;
  double sum = 0.0;
  for (int first = 0; first < count; first += kRun) {
    const int end = std::min(count, first + kRun);
    Real lanes[kPartialSums] = {};
    int i = first;
    for (; i + kPartialSums <= end; i += kPartialSums) {
      for (int lane = 0; lane < kPartialSums; ++lane) lanes[lane] += term(i + lane);
    }
    for (const Real lane : lanes) sum += static_cast<double>(lane);
    for (; i < end; ++i) sum += static_cast<double>(term(i));
  }
  return sum;
}

}  // namespace robot_tissue
