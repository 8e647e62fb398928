// Tables of what was measured at some Poisson's ratios, ascending: rows with a `poisson_ratio`.
#pragma once

#include <algorithm>
#include <cstddef>

namespace robot_tissue {

// Rows of a table between which a ratio is, and its share of the way; the outermost row beyond it.
template <typename Row>
struct RatioPlace {
  const Row& low;
  const Row& high;
  double share;
};

template <typename Row, std::size_t kRows>
RatioPlace<Row> placeIn(const Row (&table)[kRows], double poisson_ratio) {
  std::size_t high = 0;
  while (high + 1 < kRows && poisson_ratio > table[high].poisson_ratio) ++high;
  const Row& low = table[high == 0 ? 0 : high - 1];
  const double width = table[high].poisson_ratio - low.poisson_ratio;
  const double share = width > 0.0 ? (poisson_ratio - low.poisson_ratio) / width : 0.0;
  return {low, table[high], std::min(share, 1.0)};
}

}  // namespace robot_tissue
