#include "lattice/slivers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

namespace robot_tissue {
namespace {

double leastSpread(const Cell& cell) {
  return cell.fill != nullptr ? cell.fill->spread[0] : CellFill().spread[0];
}

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
  std::vector<double> spreads;
  for (const Cell& cell : cells) {
    double spread = leastSpread(cell);
    for (std::size_t corner = 0; isInPart(cell) && corner < kCorners; ++corner) {
      const int node = cell.nodes[corner];
      for (const int* other = beside.begin(node); other != beside.end(node); ++other) {
        const Cell& lender = cells[at(*other)];
        const double lent = std::min(1.0, lender.share() / cell.share());
        const double least = leastSpread(lender);
        spread = std::max(spread, lent * least * least / CellFill().spread[0]);
      }
    }
    spreads.push_back(spread);
  }
  for (std::size_t index = 0; index < cells.size(); ++index) {
    if (spreads[index] == leastSpread(cells[index])) continue;
    CellFill raised = *cells[index].fill;
    raised.spread = raised.spread.cwiseMax(spreads[index]);
    cells[index].fill = std::make_shared<const CellFill>(raised);
  }
}

std::shared_ptr<const CellFill> unraised(const std::shared_ptr<const CellFill>& fill) {
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  const Vec3 spread = Solver(fill->covariance(), Eigen::EigenvaluesOnly).eigenvalues();
  if (spread == fill->spread) return fill;
  CellFill before = *fill;
  before.spread = spread;
  return std::make_shared<const CellFill>(before);
}

}  // namespace robot_tissue
