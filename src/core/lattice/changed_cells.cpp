#include "lattice/changed_cells.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {

double shareChanged(const CellSet& one, const CellSet& other) {
  const auto key = [](const Cell& cell) { return std::make_pair(cell.place, cell.own); };
  const std::vector<Cell>&left = one.all(), &right = other.all();
  std::size_t apart = 0;
  auto a = left.begin(), b = right.begin();
  while (a != left.end() && b != right.end()) {
    if (key(*a) == key(*b)) {
      ++a;
      ++b;
      continue;
    }
    ++apart;
    key(*a) < key(*b) ? ++a : ++b;
  }
  apart += static_cast<std::size_t>((left.end() - a) + (right.end() - b));
  const std::size_t most = std::max(left.size(), right.size());
  return most == 0 ? 0.0 : static_cast<double>(apart) / static_cast<double>(most);
}

}  // namespace robot_tissue
