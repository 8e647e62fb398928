// GridHierarchy: what is beyond the part that the finest lattice is solved for.
#include <algorithm>
#include <cmath>

#include "simd/field_kernel.h"
#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

namespace robot_tissue {
namespace {

// Root mean square of t (1 - t) / 2, t in 0 .. 1: what a linear mean misses of a second difference
// of 1, on the way from one point to the next.
constexpr double kMissed = 0.0913;

// Nodes of the finest lattice for one of the level, times a square of its spacing.
double weightOf(std::size_t level) { return std::pow(32.0, static_cast<double>(level)); }

}  // namespace

// Visits a level's own rows, less what a finer one covers: their first entries and lengths.
template <typename Real>
template <typename Visit>
void GridHierarchy<Real>::forRowsBeyond(std::size_t level, Visit visit) const {
  const LevelGrid& grid = levels_[level].grid();
  const GridBox& free = levels_[level].part().free;
  const GridBox& covered = levels_[level].part().covered;
  const auto row = [&](int from, int to, int j, int k) {
    if (from <= to) visit(grid.index(from, j, k), to - from + 1);
  };
  for (int k = free.low[2]; k <= free.high[2]; ++k) {
    for (int j = free.low[1]; j <= free.high[1]; ++j) {
      if (covered.has({covered.low[0], j, k})) {
        row(free.low[0], covered.low[0] - 1, j, k);
        row(covered.high[0] + 1, free.high[0], j, k);
      } else {
        row(free.low[0], free.high[0], j, k);
      }
    }
  }
}

template <typename Real>
double GridHierarchy<Real>::squaredBeyond(std::size_t level, const Field<Real>& of,
                                          const Field<Real>* less) const {
  double squared = 0.0;
  forRowsBeyond(level, [&](int first, int count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Real* values = of[axis].data() + first;
      squared += less == nullptr ? dotOf(values, values, count)
                                 : squaredDistance(values, (*less)[axis].data() + first, count);
    }
  });
  return weightOf(level) * squared;
}

template <typename Real>
double GridHierarchy<Real>::squaredMotionBeyond() const {
  double squared = 0.0;
  for (std::size_t level = 1; level < levels_.size() && !isWhole(); ++level) {
    squared += squaredBeyond(level, motion_beyond_[level - 1], nullptr);
  }
  return squared;
}

template <typename Real>
double GridHierarchy<Real>::squaredDisplacementBeyond() const {
  double squared = 0.0;
  for (std::size_t level = 1; level < levels_.size() && !isWhole(); ++level) {
    squared += squaredBeyond(level, levels_[level].displacement, nullptr);
  }
  return squared;
}

template <typename Real>
double GridHierarchy<Real>::squaredDistanceBeyond(const Beyond& places) const {
  double squared = 0.0;
  for (std::size_t index = 0; index < places.size(); ++index) {
    squared += squaredBeyond(index + 1, levels_[index + 1].displacement, &places[index]);
  }
  return squared;
}

template <typename Real>
double GridHierarchy<Real>::squaredRoughnessBeyond() const {
  double squared = 0.0;
  for (std::size_t level = 1; level < levels_.size() && !isWhole(); ++level) {
    squared += roughness(level);
  }
  return squared;
}

// What the coarse levels moved, as a motion yet to be made.
template <typename Real>
void GridHierarchy<Real>::takeMotion() {
  motion_beyond_.resize(links_.size());
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const Field<Real>& start = links_[level - 1].start;
    Field<Real>& moved = motion_beyond_[level - 1];
    Field<Real>& now = levels_[level].displacement;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved[axis].resize(now[axis].size());
      subtract(now[axis].data(), start[axis].data(), Real(1), moved[axis].data(),
               levels_[level].count());
    }
    now = start;
  }
}

template <typename Real>
typename GridHierarchy<Real>::Beyond GridHierarchy<Real>::placesBeyond() const {
  Beyond places;
  for (std::size_t level = 1; level < levels_.size() && !isWhole(); ++level) {
    places.push_back(levels_[level].displacement);
  }
  return places;
}

template <typename Real>
void GridHierarchy<Real>::putBeyond(const Beyond& places) {
  for (std::size_t index = 0; index < places.size(); ++index) {
    levels_[index + 1].displacement = places[index];
  }
  if (!places.empty()) placeInterfaces();
}

template <typename Real>
void GridHierarchy<Real>::moveBeyond(const Beyond& step, double share) {
  for (std::size_t index = 0; index < step.size(); ++index) {
    GridLevel<Real>& level = levels_[index + 1];
    level.moveBy(step[index],
                 std::vector<GroupVector>(level.constrained.groups.size(), GroupVector::Zero()),
                 share);
  }
  if (!step.empty()) placeInterfaces();
}

template <typename Real>
typename GridHierarchy<Real>::Beyond GridHierarchy<Real>::findForcesBeyond() {
  Beyond forces;
  for (std::size_t level = 1; level < levels_.size() && !isWhole(); ++level) {
    restrictTo(level);
    const Field<Real>& all = levels_[level].force;
    forces.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      forces.back()[axis].assign(all[axis].size(), Real(0));
    }
    forRowsBeyond(level, [&](int first, int count) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(all[axis].begin() + first, count, forces.back()[axis].begin() + first);
      }
    });
  }
  return forces;
}

template <typename Real>
double GridHierarchy<Real>::workBeyond(const Beyond& force, const Beyond& motion) {
  double work = 0.0, unit = 1.0;
  for (std::size_t index = 0; index < motion.size(); ++index) {
    unit *= 8.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      work += unit * dotOf(force[index][axis].data(), motion[index][axis].data(),
                           static_cast<int>(motion[index][axis].size()));
    }
  }
  return work;
}

// By second differences along the axes.
template <typename Real>
double GridHierarchy<Real>::roughness(std::size_t level) const {
  const GridLevel<Real>& lattice = levels_[level];
  const LevelGrid& grid = lattice.grid();
  const GridBox& free = lattice.part().free;
  const std::array<int, 3> strides = {1, grid.row, grid.plane};
  double squared = 0.0;
  for (int k = free.low[2]; k <= free.high[2]; ++k) {
    for (int j = free.low[1]; j <= free.high[1]; ++j) {
      for (int i = free.low[0]; i <= free.high[0]; ++i) {
        const std::array<int, 3> place = {i, j, k};
        if (lattice.part().covered.has(place)) continue;
        const int node = grid.index(i, j, k);
        for (const auto& values : lattice.displacement) {
          for (std::size_t along = 0; along < 3; ++along) {
            if (place[along] == 0 || place[along] == grid.size[along] - 1) continue;
            const double difference =
                static_cast<double>(values[at(node + strides[along])] +
                                    values[at(node - strides[along])] - 2 * values[at(node)]);
            squared += difference * difference;
          }
        }
      }
    }
  }
  return kMissed * kMissed * weightOf(level) * squared;
}

// In spacings of the finest lattice; the place is one of the level's whole grid.
template <typename Real>
Vec3 GridHierarchy<Real>::valueAt(std::size_t level, const std::array<int, 3>& place) const {
  const GridBox points = pointsOf(level);
  if (points.has(place)) {
    const int entry = levels_[level].grid().index(
        place[0] - points.low[0], place[1] - points.low[1], place[2] - points.low[2]);
    return std::ldexp(1.0, static_cast<int>(level)) * vectorAt(levels_[level].displacement, entry);
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
Vec3 GridHierarchy<Real>::displacementOf(int node) const {
  if (!sources_.empty()) return spacing_ * valueAt(0, lattice_.gridIndex(node));
  return spacing_ * vectorAt(levels_.front().displacement, entryOf(node));
}

template <typename Real>
void GridHierarchy<Real>::writeTo(std::vector<Vec3>& displacement,
                                  const std::vector<std::uint8_t>& held) const {
  const auto& from = levels_.front().displacement;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::size_t node = at(nodes_[i]);
    if (held[node] == kAllAxes) continue;
    const Vec3 moved = spacing_ * vectorAt(from, entries_[i]);
    for (int axis = 0; axis < 3; ++axis) {
      if ((held[node] >> axis & 1) == 0) displacement[node][axis] = moved[axis];
    }
  }
  if (!isWhole()) writeBeyond(displacement);
}

// All of the next coarser lattice, then of the finest.
template <typename Real>
void GridHierarchy<Real>::writeBeyond(std::vector<Vec3>& displacement) const {
  Field<Real> coarse = levels_.back().displacement;
  LevelGrid coarse_grid(sources_.back().size);
  for (std::size_t level = levels_.size() - 1; level-- > 0;) {
    for (auto& values : coarse) {
      for (Real& value : values) value *= static_cast<Real>(GridTransfer<Real>::kTwice);
    }
    const LevelGrid grid(sources_[level].size);
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
      std::vector<Real> between;
      for (int k = 0; k < grid.size[2]; ++k) {
        transfer.prolongPlane(coarse[axis], k, between, fine[axis].data() + grid.index(0, 0, k));
      }
    }
    putOpen(level, grid, fine);
    coarse = std::move(fine);
    coarse_grid = grid;
  }
}

// What is solved for on a level.
template <typename Real>
void GridHierarchy<Real>::putOpen(std::size_t level, const LevelGrid& grid,
                                  Field<Real>& all) const {
  const GridBox points = pointsOf(level);
  for (int k = points.low[2]; k <= points.high[2]; ++k) {
    for (int j = points.low[1]; j <= points.high[1]; ++j) {
      const int first = levels_[level].grid().index(0, j - points.low[1], k - points.low[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(levels_[level].displacement[axis].begin() + first,
                    points.high[0] - points.low[0] + 1,
                    all[axis].begin() + grid.index(points.low[0], j, k));
      }
    }
  }
}

// In all threads there are.
template <typename Real>
void GridHierarchy<Real>::writePlanes(const GridTransfer<Real>& transfer, const Field<Real>& coarse,
                                      std::vector<Vec3>& displacement) const {
  const int planes = lattice_.size()[2];
  if (workers_ == nullptr) return writePlanes(transfer, coarse, 0, planes, displacement);
  const int threads = workers_->count();
  workers_->run([&](int part) {
    writePlanes(transfer, coarse, planes * part / threads, planes * (part + 1) / threads,
                displacement);
  });
}

template <typename Real>
void GridHierarchy<Real>::writePlanes(const GridTransfer<Real>& transfer, const Field<Real>& coarse,
                                      int first, int end, std::vector<Vec3>& displacement) const {
  const GridBox open = pointsOf(0);
  const auto& size = lattice_.size();
  const LevelGrid grid(sources_.front().size);
  Field<Real> plane;
  for (auto& values : plane) values.resize(at(grid.plane));
  std::vector<Real> between;
  for (int k = first; k < end; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      transfer.prolongPlane(coarse[axis], k, between, plane[axis].data());
    }
    for (int j = 0; j < size[1]; ++j) {
      Vec3* const row = displacement.data() + lattice_.node(0, j, k);
      const auto put = [&](int from, int to) {
        for (int i = from; i <= to; ++i) row[i] = spacing_ * vectorAt(plane, grid.index(i, j, 0));
      };
      const bool beside = open.has({open.low[0], j, k});
      put(0, beside ? open.low[0] - 1 : size[0] - 1);
      if (beside) put(open.high[0] + 1, size[0] - 1);
    }
  }
}

// From the coarsest on.
template <typename Real>
void GridHierarchy<Real>::placeInterfaces() {
  for (std::size_t level = links_.size(); level-- > 0;) {
    links_[level].transfer.place(levels_[level + 1].displacement, levels_[level].interfaceNodes(),
                                 levels_[level].displacement);
  }
}

template class GridHierarchy<float>;
template class GridHierarchy<double>;

}  // namespace robot_tissue
