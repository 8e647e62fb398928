#include "solvers/multigrid/hierarchy/uncovered_part.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simd/field_kernel.h"

namespace robot_tissue {
namespace {

// Between two points, a linear mean misses t (1 - t) / 2 times the second difference, t in 0 .. 1;
// the root mean square of that factor is 120^(-1/2).
constexpr double kMissed = 0.0913;

// Nodes of the finest lattice for one of the level, times a square of its spacing: 8^l 4^l.
double weightOf(std::size_t level) { return std::pow(32.0, static_cast<double>(level)); }

}  // namespace

// Visits a level's open rows, less what a finer one covers: their first entries and lengths.
template <typename Real>
template <typename Visit>
void UncoveredPart<Real>::forRows(std::size_t level, Visit visit) const {
  const LevelGrid& grid = grid_.level(level).grid();
  const GridBox& free = grid_.level(level).part().free;
  const GridBox& covered = grid_.level(level).part().covered;
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
double UncoveredPart<Real>::squaredOn(std::size_t level, const Field<Real>& of,
                                      const Field<Real>* less) const {
  double squared = 0.0;
  forRows(level, [&](int first, int count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Real* values = of[axis].data() + first;
      squared += less == nullptr ? dotOf(values, values, count)
                                 : squaredDistance(values, (*less)[axis].data() + first, count);
    }
  });
  return weightOf(level) * squared;
}

template <typename Real>
double UncoveredPart<Real>::squared(const Vector& motion) const {
  double squared = 0.0;
  for (std::size_t index = 0; index < motion.size(); ++index) {
    squared += squaredOn(index + 1, motion[index], nullptr);
  }
  return squared;
}

template <typename Real>
double UncoveredPart<Real>::squaredDistanceFrom(const Vector& places) const {
  double squared = 0.0;
  for (std::size_t index = 0; index < places.size(); ++index) {
    squared += squaredOn(index + 1, grid_.level(index + 1).displacement, &places[index]);
  }
  return squared;
}

template <typename Real>
double UncoveredPart<Real>::squaredDisplacement() const {
  double squared = 0.0;
  for (std::size_t level = 1; level < grid_.levelCount() && !grid_.isWhole(); ++level) {
    squared += squaredOn(level, grid_.level(level).displacement, nullptr);
  }
  return squared;
}

template <typename Real>
double UncoveredPart<Real>::squaredRoughness() const {
  double squared = 0.0;
  for (std::size_t level = 1; level < grid_.levelCount() && !grid_.isWhole(); ++level) {
    squared += kMissed * kMissed * weightOf(level) * squaredDifferences(level);
  }
  return squared;
}

// Second differences along the axes, in the level's spacing.
template <typename Real>
double UncoveredPart<Real>::squaredDifferences(std::size_t index) const {
  const GridLevel<Real>& level = grid_.level(index);
  const LevelGrid& grid = level.grid();
  const GridBox& free = level.part().free;
  const std::array<int, 3> strides = {1, grid.row, grid.plane};
  double squared = 0.0;
  for (int k = free.low[2]; k <= free.high[2]; ++k) {
    for (int j = free.low[1]; j <= free.high[1]; ++j) {
      for (int i = free.low[0]; i <= free.high[0]; ++i) {
        const std::array<int, 3> place = {i, j, k};
        if (level.part().covered.has(place)) continue;
        const int node = grid.index(i, j, k);
        for (const auto& values : level.displacement) {
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
  return squared;
}

template <typename Real>
typename UncoveredPart<Real>::Vector UncoveredPart<Real>::places() const {
  Vector places;
  for (std::size_t level = 1; level < grid_.levelCount() && !grid_.isWhole(); ++level) {
    places.push_back(grid_.level(level).displacement);
  }
  return places;
}

template <typename Real>
void UncoveredPart<Real>::placeAt(const Vector& places) {
  for (std::size_t index = 0; index < places.size(); ++index) {
    grid_.level(index + 1).displacement = places[index];
  }
  if (!places.empty()) grid_.placeInterfaces();
}

template <typename Real>
void UncoveredPart<Real>::moveBy(const Vector& step, double alpha) {
  for (std::size_t index = 0; index < step.size(); ++index) {
    GridLevel<Real>& level = grid_.level(index + 1);
    level.moveBy(step[index],
                 std::vector<GroupVector>(level.constrained.groups.size(), GroupVector::Zero()),
                 alpha);
  }
  if (!step.empty()) grid_.placeInterfaces();
}

template <typename Real>
typename UncoveredPart<Real>::Vector UncoveredPart<Real>::findForces() {
  Vector forces;
  for (std::size_t level = 1; level < grid_.levelCount() && !grid_.isWhole(); ++level) {
    restriction_.restrictTo(level);
    const Field<Real>& all = grid_.level(level).force;
    forces.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      forces.back()[axis].assign(all[axis].size(), Real(0));
    }
    forRows(level, [&](int first, int count) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(all[axis].begin() + first, count, forces.back()[axis].begin() + first);
      }
    });
  }
  return forces;
}

template <typename Real>
double UncoveredPart<Real>::workOf(const Vector& force, const Vector& step) {
  double work = 0.0, unit = 1.0;
  for (std::size_t index = 0; index < step.size(); ++index) {
    unit *= 8.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      work += unit * dotOf(force[index][axis].data(), step[index][axis].data(),
                           static_cast<int>(step[index][axis].size()));
    }
  }
  return work;
}

template class UncoveredPart<float>;
template class UncoveredPart<double>;

}  // namespace robot_tissue
