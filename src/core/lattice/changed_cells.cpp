#include "lattice/changed_cells.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {

ChangedCells changedCells(const Lattice& lattice, const CellSet& one, const CellSet& other) {
  ChangedCells changed;
  changed.box = {{1, 1, 1}, {0, 0, 0}};
  std::size_t count = 0;
  const auto add = [&](const Cell& cell) {
    const auto& nodes = lattice.cells()[at(cell.place)].nodes;
    changed.box =
        joined(changed.box, {lattice.gridIndex(nodes.front()), lattice.gridIndex(nodes.back())});
    ++count;
  };
  const auto key = [](const Cell& cell) { return std::make_pair(cell.place, cell.own); };
  const std::vector<Cell>&left = one.all(), &right = other.all();
  auto a = left.begin(), b = right.begin();
  while (a != left.end() && b != right.end()) {
    if (key(*a) == key(*b)) {
      ++a;
      ++b;
      continue;
    }
    add(key(*a) < key(*b) ? *a++ : *b++);
  }
  std::for_each(a, left.end(), add);
  std::for_each(b, right.end(), add);
  const std::size_t most = std::max(left.size(), right.size());
  if (most > 0) changed.share = static_cast<double>(count) / static_cast<double>(most);
  return changed;
}

}  // namespace robot_tissue
