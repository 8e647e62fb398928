// GridHierarchy: the parts of the levels that are solved for.
#include <algorithm>
#include <cmath>

#include "solvers/multigrid/hierarchy/grid_hierarchy.h"
#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

int countOf(const GridBox& box) {
  return (box.high[0] - box.low[0] + 1) * (box.high[1] - box.low[1] + 1) *
         (box.high[2] - box.low[2] + 1);
}

// Coarse nodes whose fine ones, those next to them too, may all move.
GridBox coveredBy(const GridBox& free, const GridBox& whole) {
  GridBox covered;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool to_the_end = free.high[axis] == whole.high[axis];
    covered.low[axis] = (free.low[axis] + 1) / 2;
    covered.high[axis] = (free.high[axis] + (to_the_end ? 1 : 0)) / 2;
  }
  return covered;
}

GridBox around(const GridBox& box, int layers) {
  GridBox wider = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wider.low[axis] -= layers;
    wider.high[axis] += layers;
  }
  return wider;
}

// So that the points just beyond are points of the next coarser level, or the block ends there.
GridBox fitted(const GridBox& box, const GridBox& whole) {
  GridBox fit = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    fit.low[axis] = box.low[axis] <= 2 ? 0 : box.low[axis] - 1 + box.low[axis] % 2;
    const int high = box.high[axis] + 1 - box.high[axis] % 2;
    fit.high[axis] = high >= whole.high[axis] - 2 ? whole.high[axis] : high;
  }
  return countOf(fit) > tuning::kMostOpen * countOf(whole) ? whole : fit;
}

LevelGrid gridOf(const GridBox& points) {
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    size[axis] = points.high[axis] - points.low[axis] + 1;
  return LevelGrid(size);
}

// Where a place next to the grid's end would be, as the nodes before it go on.
NodeShares goingOn(const LevelGrid& grid, const std::array<int, 3>& beyond) {
  std::array<int, 3> last = beyond;
  for (std::size_t axis = 0; axis < 3; ++axis)
    last[axis] = std::min(last[axis], grid.size[axis] - 1);
  NodeShares shares = {{grid.index(last[0], last[1], last[2]), 1.0}};
  const std::array<int, 3> strides = {1, grid.row, grid.plane};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (last[axis] == beyond[axis]) continue;
    const std::size_t count = shares.size();
    for (std::size_t i = 0; i < count; ++i) {
      shares.push_back({shares[i].node - strides[axis], -shares[i].weight});
      shares[i].weight *= 2.0;
    }
  }
  return shares;
}

GridBox from(const GridBox& box, const std::array<int, 3>& origin) {
  GridBox local = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    local.low[axis] -= origin[axis];
    local.high[axis] -= origin[axis];
  }
  return local;
}

}  // namespace

template <typename Real>
GridBox GridHierarchy<Real>::whole() const {
  return wholeOf(lattice_.size());
}

// Of lattices of equal cells, by a block of them that all stand for finer ones, the stiffest there
// is: not of each part anew.
template <typename Real>
void GridHierarchy<Real>::measureStiffness() {
  for (std::size_t level = 0; level < sources_.size(); ++level) {
    LevelSource& source = sources_[level];
    if (!source.isUniform()) continue;
    GridBox points = source.whole();
    for (int& high : points.high) high = std::min(high, tuning::kMeasuredCells);
    const LevelGrid grid = gridOf(points);
    const GridLevel<Real> block(grid, 0, source.cellsIn(points, grid),
                                {points, level == 0 ? GridBox{{1}, {0}} : points});
    source.greatest_stiffness = block.greatestStiffness();
  }
}

// As what a tool touches, but always the same.
template <typename Real>
GridBox GridHierarchy<Real>::middle() const {
  GridBox box = whole();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = box.high[axis] = box.high[axis] / 2;
  }
  return around(box, tuning::kAroundMiddle);
}

template <typename Real>
bool GridHierarchy<Real>::open(const GridBox& box, int layers,
                               const std::vector<Vec3>& displacement) {
  if (sources_.empty()) return false;
  const std::vector<GridBox> free = partsAround(box, layers);
  if (free == free_) return false;
  openParts(free);
  bond_ = Bond();
  setDisplacement(displacement, std::vector<std::uint8_t>(displacement.size(), 0));
  placeCoarse(displacement);
  return true;
}

// Where a level is open as a whole, the coarser ones are.
template <typename Real>
std::vector<GridBox> GridHierarchy<Real>::partsAround(const GridBox& box, int layers) const {
  std::vector<GridBox> free;
  GridBox wanted = box;
  for (std::size_t level = 0; level < sources_.size(); ++level) {
    const LevelSource& source = sources_[level];
    const bool has_coarser = level + 1 < sources_.size() && sources_[level + 1].isThick();
    if (!source.rough.isEmpty())
      wanted = joined(wanted, around(source.rough, tuning::kBesideRough));
    free.push_back(has_coarser ? fitted(wanted, source.whole()) : source.whole());
    wanted = around(coveredBy(free.back(), source.whole()), layers);
  }
  return free;
}

// The nodes that may move, and those next to them.
template <typename Real>
GridBox GridHierarchy<Real>::pointsOf(std::size_t level) const {
  const GridBox whole = sources_[level].whole();
  GridBox points = around(free_[level], 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    points.low[axis] = std::max(points.low[axis], 0);
    points.high[axis] = std::min(points.high[axis], whole.high[axis]);
  }
  return points;
}

template <typename Real>
void GridHierarchy<Real>::openParts(const std::vector<GridBox>& free) {
  free_ = free;
  levels_.clear();
  links_.clear();
  motions_.clear();
  for (std::size_t level = 0; level < free_.size(); ++level) {
    LevelSource& source = sources_[level];
    const GridBox points = pointsOf(level);
    const LevelGrid grid = gridOf(points);
    const LevelPart part = {
        from(free_[level], points.low),
        level == 0 ? GridBox{{1}, {0}}
                   : from(coveredBy(free_[level - 1], sources_[level - 1].whole()), points.low)};
    if (level > 0) addLink(transferTo(level, grid));
    addLevel(grid, 0, source.cellsIn(points, grid), part, source.greatest_stiffness);
  }
  motion = std::move(motions_.front());
  levels_.front().constrained.setUnits(spacing_, modulus_);
  nodes_.clear();
  entries_.clear();
  const GridBox points = pointsOf(0);
  for (int k = points.low[2]; k <= points.high[2]; ++k) {
    for (int j = points.low[1]; j <= points.high[1]; ++j) {
      for (int i = points.low[0]; i <= points.high[0]; ++i) {
        nodes_.push_back(lattice_.node(i, j, k));
        entries_.push_back(entryOf(nodes_.back()));
      }
    }
  }
}

template <typename Real>
GridTransfer<Real> GridHierarchy<Real>::transferTo(std::size_t level, const LevelGrid& grid) {
  const GridBox fine = pointsOf(level - 1), points = pointsOf(level);
  const LevelGrid& fine_grid = levels_.back().grid();
  std::array<int, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = fine.low[axis] / 2 - points.low[axis];
  Coarsening to;
  to.grid = grid;
  for (int k = 0; k <= fine_grid.size[2] / 2; ++k) {
    for (int j = 0; j <= fine_grid.size[1] / 2; ++j) {
      for (int i = 0; i <= fine_grid.size[0] / 2; ++i) {
        const std::array<int, 3> twice = {2 * i, 2 * j, 2 * k};
        if (fine_grid.whole().has(twice)) continue;
        to.starts.push_back(
            {grid.index(place[0] + i, place[1] + j, place[2] + k), goingOn(fine_grid, twice)});
      }
    }
  }
  return {fine_grid, std::move(to), place};
}

template <typename Real>
int GridHierarchy<Real>::entryOf(int node) const {
  if (sources_.empty()) return entries_[at(node)];
  const GridBox points = pointsOf(0);
  const std::array<int, 3>& place = lattice_.gridIndex(node);
  if (!points.has(place)) return -1;
  return levels_.front().grid().index(place[0] - points.low[0], place[1] - points.low[1],
                                      place[2] - points.low[2]);
}

// Visits the points that a coarse level has open, with the node at each one's place, or next to it
// where the block ends before.
template <typename Real>
template <typename Visit>
void GridHierarchy<Real>::forPoints(std::size_t level, Visit visit) const {
  const GridBox points = pointsOf(level);
  const LevelGrid& grid = levels_[level].grid();
  const auto& last = whole().high;
  for (int k = points.low[2]; k <= points.high[2]; ++k) {
    for (int j = points.low[1]; j <= points.high[1]; ++j) {
      for (int i = points.low[0]; i <= points.high[0]; ++i) {
        const std::array<int, 3> there = {std::min(i << level, last[0]),
                                          std::min(j << level, last[1]),
                                          std::min(k << level, last[2])};
        visit(grid.index(i - points.low[0], j - points.low[1], k - points.low[2]),
              lattice_.node(there[0], there[1], there[2]));
      }
    }
  }
}

// Of a block, in all the coarse parts that are open: where the nodes at their places are.
template <typename Real>
void GridHierarchy<Real>::placeCoarse(const std::vector<Vec3>& displacement) {
  if (sources_.empty()) return;
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const double unit = 1.0 / (spacing_ * (1 << level));
    forPoints(level, [&](int entry, int node) {
      for (int axis = 0; axis < 3; ++axis) {
        levels_[level].displacement[at(axis)][at(entry)] =
            static_cast<Real>(unit * displacement[at(node)][axis]);
      }
    });
  }
}

template <typename Real>
void GridHierarchy<Real>::holdFixed(std::size_t level) {
  forPoints(level, [&](int entry, int node) {
    if (lattice_.isFixed(node)) levels_[level].hold(entry, kAllAxes);
  });
}

template class GridHierarchy<float>;
template class GridHierarchy<double>;

}  // namespace robot_tissue
