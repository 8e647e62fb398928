#include "lattice/slivers.h"

#include <algorithm>
#include <numeric>

namespace robot_tissue {
namespace {

bool isInPart(const Cell& cell) { return cell.fill != nullptr; }

// Cells by their nodes, of nodes of cells that are filled in part.
class CellsAtNodes {
 public:
  CellsAtNodes(const std::vector<Cell>& cells, int node_count) : first_(at(node_count) + 1, 0) {
    std::vector<char> is_asked(at(node_count), 0);
    for (const Cell& cell : cells) {
      if (!isInPart(cell)) continue;
      for (const int node : cell.nodes) is_asked[at(node)] = 1;
    }
    for (const Cell& cell : cells) {
      for (const int node : cell.nodes) first_[at(node) + 1] += is_asked[at(node)];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    cells_.resize(at(first_.back()));
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      for (const int node : cells[cell].nodes) {
        if (is_asked[at(node)] != 0) cells_[at(next[at(node)]++)] = static_cast<int>(cell);
      }
    }
  }

  const int* begin(int node) const { return cells_.data() + first_[at(node)]; }
  const int* end(int node) const { return cells_.data() + first_[at(node) + 1]; }

 private:
  std::vector<int> first_, cells_;
};

}  // namespace

void stiffenSlivers(std::vector<Cell>& cells, int node_count) {
  if (std::none_of(cells.begin(), cells.end(), isInPart)) return;
  const CellsAtNodes beside(cells, node_count);
  for (Cell& cell : cells) {
    if (!isInPart(cell)) continue;
    const bool is_beside_full = std::any_of(cell.nodes.begin(), cell.nodes.end(), [&](int node) {
      return std::any_of(beside.begin(node), beside.end(node),
                         [&](int other) { return !isInPart(cells[at(other)]); });
    });
    if (!is_beside_full) continue;
    CellFill raised = *cell.fill;
    raised.lent = CellFill().spread[0];
    cell.fill = SharedConst<CellFill>(raised);
  }
}

SharedConst<CellFill> unraised(const SharedConst<CellFill>& fill) {
  if (fill->lent == 0.0) return fill;
  CellFill before = *fill;
  before.lent = 0.0;
  return SharedConst<CellFill>(before);
}

}  // namespace robot_tissue
