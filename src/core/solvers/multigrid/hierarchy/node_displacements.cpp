#include "solvers/multigrid/hierarchy/node_displacements.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "solvers/multigrid/hierarchy/free_ends.h"
#include "solvers/multigrid/hierarchy/tuning.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {

namespace tuning = hierarchy_tuning;

// Axis by axis: nodes in a row of the grid are neighbors in a component's array.
template <typename Real>
bool NodeDisplacements<Real>::take(const std::vector<Vec3>& displacement,
                                   const std::vector<std::uint8_t>& held) {
  const double unit = 1.0 / grid_.spacing();
  const std::vector<int>&nodes = grid_.nodes(), &entries = grid_.entries();
  std::atomic<bool> moved{false}, others_moved{false};
  forNodes([&](std::size_t first, std::size_t end) {
    bool moved_here = false, others_moved_here = false;
    for (int axis = 0; axis < 3; ++axis) {
      Real* to = grid_.finest().displacement[at(axis)].data();
      for (std::size_t i = first; i < end; ++i) {
        const std::size_t node = at(nodes[i]);
        Real& here = to[entries[i]];
        const Real now = static_cast<Real>(displacement[node][axis] * unit);
        const bool same = std::abs(now - here) <= tuning::kSame * std::abs(here);
        if (same) continue;
        here = now;
        moved_here = true;
        others_moved_here = others_moved_here || held[node] == 0;
      }
    }
    if (moved_here) moved = true;
    if (others_moved_here) others_moved = true;
  });
  if (others_moved) takeCoarse(displacement);
  return moved;
}

// Calls visit(first, end) for parts of the grid's nodes, each in a thread.
template <typename Real>
template <typename Visit>
void NodeDisplacements<Real>::forNodes(Visit visit) const {
  const std::size_t count = grid_.nodes().size();
  Workers* const workers = grid_.workers();
  if (workers == nullptr || count <= at(level_tuning::kSpan)) return visit(0, count);
  workers->share(static_cast<int>(count),
                 [&visit](int first, int end) { visit(at(first), at(end)); });
}

template <typename Real>
void NodeDisplacements<Real>::takeCoarse(const std::vector<Vec3>& displacement) {
  if (!grid_.isBlock()) return;
  for (std::size_t level = 1; level < grid_.levelCount(); ++level) {
    const double unit = 1.0 / (grid_.spacing() * (1 << level));
    Field<Real>& to = grid_.level(level).displacement;
    grid_.forNodesAt(level, [&](int entry, int node) {
      for (int axis = 0; axis < 3; ++axis) {
        to[at(axis)][at(entry)] = static_cast<Real>(unit * displacement[at(node)][axis]);
      }
    });
  }
}

// Of an end's node, that of the point at which the end begins: as good where an end turns little.
template <typename Real>
Vec3 NodeDisplacements<Real>::of(int node) const {
  const int entry = grid_.entryOf(node);
  if (entry < 0 && grid_.hasEnds()) {
    const std::array<int, 3> place = grid_.lattice().gridIndex(node);
    const GridBox& between = grid_.between();
    const auto along = [&](std::size_t axis) {
      return std::clamp(place[axis], between.low[axis], between.high[axis]);
    };
    return of(grid_.lattice().node(along(0), along(1), along(2)));
  }
  if (entry < 0) return grid_.spacing() * valueAt(0, grid_.lattice().gridIndex(node));
  return grid_.spacing() * vectorAt(grid_.finest().displacement, entry);
}

// In spacings of the finest lattice, at a point of the level's whole grid: where that is not open,
// the mean of the two, four or eight coarse points around it (P).
template <typename Real>
Vec3 NodeDisplacements<Real>::valueAt(std::size_t level, const std::array<int, 3>& place) const {
  const GridBox& points = grid_.points(level);
  if (points.has(place)) {
    const GridLevel<Real>& open = grid_.level(level);
    const int entry = open.grid().index(place[0] - points.low[0], place[1] - points.low[1],
                                        place[2] - points.low[2]);
    return std::ldexp(1.0, static_cast<int>(level)) * vectorAt(open.displacement, entry);
  }
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int z = place[2] / 2; z <= (place[2] + 1) / 2; ++z) {
    for (int y = place[1] / 2; y <= (place[1] + 1) / 2; ++y) {
      for (int x = place[0] / 2; x <= (place[0] + 1) / 2; ++x) {
        sum += valueAt(level + 1, {x, y, z});
        ++count;
      }
    }
  }
  return sum / count;
}

template <typename Real>
void NodeDisplacements<Real>::writeTo(std::vector<Vec3>& displacement,
                                      const std::vector<std::uint8_t>& held) const {
  const Field<Real>& from = grid_.finest().displacement;
  forNodes([&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t node = at(grid_.nodes()[i]);
      if (held[node] == kAllAxes) continue;
      const Vec3 moved = grid_.spacing() * vectorAt(from, grid_.entries()[i]);
      for (int axis = 0; axis < 3; ++axis) {
        if ((held[node] >> axis & 1) == 0) displacement[node][axis] = moved[axis];
      }
    }
  });
  if (!grid_.isWhole()) writeInterpolated(displacement);
  if (grid_.hasEnds()) moveEnds(grid_.lattice(), grid_.between(), displacement);
}

// Nodes outside of the finest level's open part. From the coarsest level down, each one's whole
// grid is filled by u = P u_coarse, then with what is open of it.
template <typename Real>
void NodeDisplacements<Real>::writeInterpolated(std::vector<Vec3>& displacement) const {
  const std::size_t coarsest = grid_.levelCount() - 1;
  Field<Real> coarse = grid_.level(coarsest).displacement;
  LevelGrid coarse_grid = grid_.wholeGrid(coarsest);
  for (std::size_t level = coarsest; level-- > 0;) {
    for (auto& values : coarse) {
      for (Real& value : values) value *= static_cast<Real>(GridTransfer<Real>::kTwice);
    }
    const LevelGrid grid = grid_.wholeGrid(level);
    Coarsening to;
    to.grid = coarse_grid;
    const GridTransfer<Real> transfer(grid, std::move(to));
    if (level == 0) {
      writePlanes(transfer, coarse, displacement);
      break;
    }
    Field<Real> fine;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fine[axis].resize(at(grid.beside));
      Numbers<Real> between;
      for (int k = 0; k < grid.size[2]; ++k) {
        transfer.prolongPlane(coarse[axis], k, between, fine[axis].data() + grid.index(0, 0, k));
      }
    }
    putOpenPart(level, grid, fine);
    coarse = std::move(fine);
    coarse_grid = grid;
  }
}

template <typename Real>
void NodeDisplacements<Real>::putOpenPart(std::size_t level, const LevelGrid& grid,
                                          Field<Real>& all) const {
  const GridBox& points = grid_.points(level);
  const GridLevel<Real>& open = grid_.level(level);
  for (int k = points.low[2]; k <= points.high[2]; ++k) {
    for (int j = points.low[1]; j <= points.high[1]; ++j) {
      const int first = open.grid().index(0, j - points.low[1], k - points.low[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(open.displacement[axis].begin() + first, points.high[0] - points.low[0] + 1,
                    all[axis].begin() + grid.index(points.low[0], j, k));
      }
    }
  }
}

// In all threads there are.
template <typename Real>
void NodeDisplacements<Real>::writePlanes(const GridTransfer<Real>& transfer,
                                          const Field<Real>& coarse,
                                          std::vector<Vec3>& displacement) const {
  const int planes = grid_.lattice().size()[2];
  Workers* const workers = grid_.workers();
  if (workers == nullptr) return writePlanes(transfer, coarse, 0, planes, displacement);
  workers->share(
      planes, [&](int first, int end) { writePlanes(transfer, coarse, first, end, displacement); });
}

template <typename Real>
void NodeDisplacements<Real>::writePlanes(const GridTransfer<Real>& transfer,
                                          const Field<Real>& coarse, int first, int end,
                                          std::vector<Vec3>& displacement) const {
  const GridBox open = grid_.points(0);
  const Lattice& lattice = grid_.lattice();
  const auto& size = lattice.size();
  const LevelGrid grid = grid_.wholeGrid(0);
  const double spacing = grid_.spacing();
  Field<Real> plane;
  for (auto& values : plane) values.resize(at(grid.plane));
  Numbers<Real> between;
  for (int k = first; k < end; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      transfer.prolongPlane(coarse[axis], k, between, plane[axis].data());
    }
    for (int j = 0; j < size[1]; ++j) {
      Vec3* const row = displacement.data() + lattice.node(0, j, k);
      const auto put = [&](int from, int to) {
        for (int i = from; i <= to; ++i) row[i] = spacing * vectorAt(plane, grid.index(i, j, 0));
      };
      const bool beside = open.has({open.low[0], j, k});
      put(0, beside ? open.low[0] - 1 : size[0] - 1);
      if (beside) put(open.high[0] + 1, size[0] - 1);
    }
  }
}

template class NodeDisplacements<float>;
template class NodeDisplacements<double>;

}  // namespace robot_tissue
