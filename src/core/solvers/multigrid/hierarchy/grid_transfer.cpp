#include "solvers/multigrid/hierarchy/grid_transfer.h"

#include <algorithm>
#include <utility>

#include "simd/field_kernel.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

// The coarse indices around a fine one along an axis: one at an even index, else two with 1/2 each.
struct Around {
  int low = 0;
  int count = 1;

  explicit Around(int fine) : low(fine / 2), count(1 + fine % 2) {}
  double weight() const { return 1.0 / count; }
};

}  // namespace

template <typename Real>
GridTransfer<Real>::GridTransfer(const LevelGrid& fine, Coarsening to, const std::array<int, 3>& at)
    : fine_(fine), to_(std::move(to)), at_(at) {}

template <typename Real>
int GridTransfer<Real>::coarseRow(int j, int k) const {
  return to_.grid.index(at_[0], at_[1] + j, at_[2] + k);
}

template <typename Real>
NodeShares GridTransfer<Real>::carriersOf(int fine_node) const {
  const auto found = std::lower_bound(
      to_.carried.begin(), to_.carried.end(), fine_node,
      [](const Coarsening::Carried& carried, int node) { return carried.node < node; });
  if (found != to_.carried.end() && found->node == fine_node) return found->carriers;
  return sharesAround(to_.grid, placeOnCoarse(fine_node));
}

// In the fine spacing, from the coarse grid's lowest point.
template <typename Real>
std::array<int, 3> GridTransfer<Real>::placeOnCoarse(int fine_node) const {
  std::array<int, 3> place = fine_.placeOf(fine_node);
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += 2 * at_[axis];
  return place;
}

template <typename Real>
template <typename Visit>
void GridTransfer<Real>::forPlanes(int planes, Visit visit) const {
  if (workers_ == nullptr || fine_.beside <= level_tuning::kSpan) return visit(0, planes);
  workers_->share(planes, visit);
}

// On the coarse nodes of some planes, along an axis, by what the grid's fine nodes have.
template <typename Real>
void GridTransfer<Real>::restrictPlanes(const Numbers<Real>& fine, int first, int end,
                                        Numbers<Real>& coarse) const {
  const auto& size = fine_.size;
  Numbers<Real> line(at(2 * countAlongX() + 1), Real(0));
  for (int k = first; k < end; ++k) {
    for (int j = 0; j <= size[1] / 2; ++j) {
      std::fill(line.begin(), line.end(), Real(0));
      for (int z = std::max(0, 2 * k - 1); z <= std::min(size[2] - 1, 2 * k + 1); ++z) {
        for (int y = std::max(0, 2 * j - 1); y <= std::min(size[1] - 1, 2 * j + 1); ++y) {
          const Real weight = Real(z == 2 * k ? 1.0 : 0.5) * Real(y == 2 * j ? 0.25 : 0.125);
          addShare(fine.data() + fine_.index(0, y, z), weight, line.data() + 1, size[0]);
        }
      }
      restrictRow(line.data(), coarse.data() + coarseRow(j, k), countAlongX());
    }
  }
}

template <typename Real>
void GridTransfer<Real>::restrictForces(const Field<Real>& fine, Field<Real>& coarse) const {
  forPlanes(fine_.size[2] / 2 + 1, [&](int first, int end) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      restrictPlanes(fine[axis], first, end, coarse[axis]);
    }
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Real* to = coarse[axis].data();
    std::fill(coarse[axis].begin() + to_.grid.beside, coarse[axis].end(), Real(0));
    for (const auto& [node, carriers] : to_.carried) {
      const Real quarter = Real(0.25) * fine[axis][at(node)];
      if (node < fine_.beside) {
        for (const NodeWeight& share : sharesAround(to_.grid, placeOnCoarse(node))) {
          to[share.node] -= static_cast<Real>(share.weight) * quarter;
        }
      }
      for (const NodeWeight& share : carriers) {
        to[share.node] += static_cast<Real>(share.weight) * quarter;
      }
    }
  }
}

template <typename Real>
void GridTransfer<Real>::restrictDisplacement(const Field<Real>& fine, const GridBox& box,
                                              Field<Real>& coarse) const {
  GridBox inside = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    inside.high[axis] = std::min(box.high[axis], at_[axis] + (fine_.size[axis] - 1) / 2);
  }
  const int from = inside.low[0] - at_[0], count = inside.high[0] - inside.low[0] + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int k = inside.low[2] - at_[2]; k <= inside.high[2] - at_[2]; ++k) {
      for (int j = inside.low[1] - at_[1]; j <= inside.high[1] - at_[1]; ++j) {
        injectRow(fine[axis].data() + fine_.index(2 * from, 2 * j, 2 * k),
                  coarse[axis].data() + coarseRow(j, k) + from, count);
      }
    }
    for (const Coarsening::Start& start : to_.starts) {
      double mean = 0.0;
      for (const NodeWeight& share : start.fine) {
        mean += share.weight * static_cast<double>(fine[axis][at(share.node)]);
      }
      coarse[axis][at(start.node)] = static_cast<Real>(mean / kTwice);
    }
  }
}

template <typename Real>
void GridTransfer<Real>::prolong(const Field<Real>& now, const Field<Real>& start,
                                 Field<Real>& fine) {
  motion_.resize(now.front().size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    subtract(now[axis].data(), start[axis].data(), static_cast<Real>(kTwice), motion_.data(),
             static_cast<int>(motion_.size()));
    forPlanes(fine_.size[2], [&](int first, int end) {
      Numbers<Real> between;
      for (int k = first; k < end; ++k) {
        prolongPlane(motion_, k, between, fine[axis].data() + fine_.index(0, 0, k));
      }
    });
    for (const auto& [node, carriers] : to_.carried) {
      double mean = 0.0;
      for (const NodeWeight& share : carriers) {
        mean += share.weight * static_cast<double>(motion_[at(share.node)]);
      }
      fine[axis][at(node)] = static_cast<Real>(mean);
    }
  }
}

template <typename Real>
void GridTransfer<Real>::prolongPlane(const Numbers<Real>& coarse, int k, Numbers<Real>& between,
                                      Real* plane) const {
  const int length = countAlongX(), stride = to_.grid.row;
  const int count = fine_.size[1] / 2 * stride + length;
  between.resize(at(count + length));
  const Around z(k);
  const Real* rows = coarse.data() + coarseRow(0, z.low);
  if (z.count > 1) {
    meanOf(rows, rows + to_.grid.plane, between.data(), count);
    rows = between.data();
  }
  Real* const line = between.data() + count;
  for (int j = 0; j < fine_.size[1]; ++j) {
    const Around y(j);
    const Real* row = rows + y.low * stride;
    if (y.count > 1) {
      meanOf(row, row + stride, line, length);
      row = line;
    }
    prolongRow(row, plane + j * fine_.row, fine_.size[0]);
  }
}

template <typename Real>
void GridTransfer<Real>::place(const Field<Real>& coarse, const std::vector<int>& nodes,
                               Field<Real>& fine) const {
  for (const int node : nodes) {
    const std::array<int, 3> place = fine_.placeOf(node);
    const Around x(place[0]), y(place[1]), z(place[2]);
    const Real weight = static_cast<Real>(kTwice * x.weight() * y.weight() * z.weight());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Real sum = 0;
      for (int c = 0; c < z.count; ++c) {
        for (int b = 0; b < y.count; ++b) {
          const Real* from = coarse[axis].data() + coarseRow(y.low + b, z.low + c) + x.low;
          for (int a = 0; a < x.count; ++a) sum += from[a];
        }
      }
      fine[axis][at(node)] = weight * sum;
    }
  }
}

template class GridTransfer<float>;
template class GridTransfer<double>;

}  // namespace robot_tissue
