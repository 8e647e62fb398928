#include "robot_tissue/core/level_transfer.h"

#include <algorithm>
#include <utility>

#include "robot_tissue/core/field_kernel.h"

namespace robot_tissue {
namespace {

// Of a row of fine nodes, along one axis: the coarse rows around it.
struct Around {
  int low = 0;
  int count = 1;

  explicit Around(int fine) : low(fine / 2), count(1 + fine % 2) {}
  double weight() const { return 1.0 / count; }
};

}  // namespace

template <typename Real>
LevelTransfer<Real>::LevelTransfer(const LevelGrid& fine, Coarsening to)
    : fine_(fine), to_(std::move(to)) {}

template <typename Real>
NodeShares LevelTransfer<Real>::carriersOf(int fine_node) const {
  const auto found = to_.carriers.find(fine_node);
  if (found != to_.carriers.end()) return found->second;
  return sharesAround(to_.grid, fine_.placeOf(fine_node));
}

template <typename Real>
void LevelTransfer<Real>::restrictForces(const Field<Real>& fine, const LevelBox& box,
                                         Field<Real>& coarse) const {
  const auto& size = fine_.size;
  std::vector<Real> line(at(2 * to_.grid.size[0] + 1), Real(0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Real* to = coarse[axis].data();
    std::fill(coarse[axis].begin() + to_.grid.beside, coarse[axis].end(), Real(0));
    for (int k = box.low[2]; k <= box.high[2]; ++k) {
      for (int j = box.low[1]; j <= box.high[1]; ++j) {
        std::fill(line.begin(), line.end(), Real(0));
        for (int z = std::max(0, 2 * k - 1); z <= std::min(size[2] - 1, 2 * k + 1); ++z) {
          for (int y = std::max(0, 2 * j - 1); y <= std::min(size[1] - 1, 2 * j + 1); ++y) {
            const Real weight = Real(z == 2 * k ? 1.0 : 0.5) * Real(y == 2 * j ? 0.25 : 0.125);
            addShare(fine[axis].data() + fine_.index(0, y, z), weight, line.data() + 1, size[0]);
          }
        }
        gatherRow(line.data(), to + to_.grid.index(0, j, k), to_.grid.size[0]);
      }
    }
    for (const int node : to_.carried) {
      const Real quarter = Real(0.25) * fine[axis][at(node)];
      if (node < fine_.beside) {
        for (const NodeShare& share : sharesAround(to_.grid, fine_.placeOf(node))) {
          to[share.node] -= static_cast<Real>(share.weight) * quarter;
        }
      }
      for (const NodeShare& share : to_.carriers.at(node)) {
        to[share.node] += static_cast<Real>(share.weight) * quarter;
      }
    }
  }
}

template <typename Real>
void LevelTransfer<Real>::restrictDisplacement(const Field<Real>& fine, const LevelBox& box,
                                               Field<Real>& coarse) const {
  const auto end = [&](std::size_t axis) {
    return std::min(box.high[axis] + 1, (fine_.size[axis] - 1) / 2);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int k = std::max(0, box.low[2] - 1); k <= end(2); ++k) {
      for (int j = std::max(0, box.low[1] - 1); j <= end(1); ++j) {
        halveRow(fine[axis].data() + fine_.index(0, 2 * j, 2 * k),
                 coarse[axis].data() + to_.grid.index(0, j, k), (fine_.size[0] + 1) / 2);
      }
    }
    for (const Coarsening::Start& start : to_.starts) {
      double mean = 0.0;
      for (const NodeShare& share : start.fine) {
        mean += share.weight * static_cast<double>(fine[axis][at(share.node)]);
      }
      coarse[axis][at(start.node)] = static_cast<Real>(mean / kTwice);
    }
  }
}

template <typename Real>
void LevelTransfer<Real>::prolong(const Field<Real>& now, const Field<Real>& start,
                                  const LevelBox& box, Field<Real>& fine) const {
  const int length = to_.grid.size[0];
  std::vector<Real> line(at(length) + 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int k = box.low[2]; k <= box.high[2]; ++k) {
      for (int j = box.low[1]; j <= box.high[1]; ++j) {
        const Around y(j), z(k);
        std::fill(line.begin(), line.end(), Real(0));
        for (int b = 0; b < z.count; ++b) {
          for (int a = 0; a < y.count; ++a) {
            const int first = to_.grid.index(0, y.low + a, z.low + b);
            const Real weight = static_cast<Real>(kTwice * y.weight() * z.weight());
            addShare(now[axis].data() + first, weight, line.data(), length);
            addShare(start[axis].data() + first, -weight, line.data(), length);
          }
        }
        spreadRow(line.data(), fine[axis].data() + fine_.index(0, j, k), fine_.size[0]);
      }
    }
    for (const int node : to_.carried) {
      double mean = 0.0;
      for (const NodeShare& share : to_.carriers.at(node)) {
        const std::size_t from = at(share.node);
        mean += share.weight * static_cast<double>(now[axis][from] - start[axis][from]);
      }
      fine[axis][at(node)] = static_cast<Real>(kTwice * mean);
    }
  }
}

template class LevelTransfer<float>;
template class LevelTransfer<double>;

}  // namespace robot_tissue
