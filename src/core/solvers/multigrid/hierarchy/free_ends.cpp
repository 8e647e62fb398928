#include "solvers/multigrid/hierarchy/free_ends.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solvers/multigrid/hierarchy/level_source.h"
#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

std::size_t longestAxis(const std::array<int, 3>& size) {
  return static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
}

// Also where it was no block before.
bool isCut(const Lattice& lattice, const CellSet& cells) {
  const auto& size = lattice.size();
  const std::size_t of_block = at((size[0] - 1) * (size[1] - 1) * (size[2] - 1));
  return of_block != lattice.cells().size() || cells.all().size() != of_block ||
         std::any_of(cells.all().begin(), cells.all().end(),
                     [](const Cell& cell) { return cell.isPart() || cell.fill != nullptr; });
}

template <typename Visit>
void forPoints(const Lattice& lattice, const GridBox& box, Visit visit) {
  for (int k = box.low[2]; k <= box.high[2]; ++k) {
    for (int j = box.low[1]; j <= box.high[1]; ++j) {
      for (int i = box.low[0]; i <= box.high[0]; ++i) visit(lattice.node(i, j, k));
    }
  }
}

// The rigid motion that fits that of these points best; where all moved alike, that exactly.
Eigen::Isometry3d motionOf(const Lattice& lattice, const GridBox& points,
                           const std::vector<Vec3>& displacement) {
  const int first = lattice.node(points.low[0], points.low[1], points.low[2]);
  const auto count = (points.high[0] - points.low[0] + 1) * (points.high[1] - points.low[1] + 1) *
                     (points.high[2] - points.low[2] + 1);
  Eigen::Matrix3Xd rest(3, count), moved(3, count);
  bool alike = true;
  int column = 0;
  forPoints(lattice, points, [&](int node) {
    rest.col(column) = lattice.restPosition(node);
    moved.col(column++) = lattice.restPosition(node) + displacement[at(node)];
    alike = alike && displacement[at(node)] == displacement[at(first)];
  });
  if (!alike) return Eigen::Isometry3d(Eigen::umeyama(rest, moved, false));
  return Eigen::Isometry3d(Eigen::Translation3d(displacement[at(first)]));
}

}  // namespace

FreeEnds::FreeEnds(const Lattice& lattice, double tolerance)
    : lattice_(lattice), axis_(longestAxis(lattice.size())) {
  std::array<int, 3> sorted = lattice.size();
  std::sort(sorted.begin(), sorted.end());
  const double ways = std::log(1.0 / (tuning::kLeftOfEnds * tolerance)) / tuning::kDecay;
  decay_ = static_cast<int>(std::ceil(std::max(1.0, ways) * (sorted[1] - 1)));
  LevelSource coarser;
  for (std::size_t axis = 0; axis < 3; ++axis) coarser.size[axis] = lattice.size()[axis] / 2 + 1;
  is_long_ = !coarser.isThick() && sorted[2] > decay_;
  forget();
  for (int node = 0; is_long_ && node < lattice.nodeCount(); ++node) {
    const std::array<int, 3> place = lattice.gridIndex(node);
    if (lattice.isFixed(node)) held_ = joined(held_, {place, place});
  }
}

void FreeEnds::forget() { between_ = is_long_ ? kNowhere : wholeOf(lattice_.size()); }

bool FreeEnds::renew(const GridBox& loaded, const std::shared_ptr<const CellSet>& cells) {
  const GridBox whole = wholeOf(lattice_.size());
  if (is_long_ && cells_ != cells) is_cut_ = isCut(lattice_, *cells);
  cells_ = cells;
  const GridBox least = is_long_ && !is_cut_ ? leastAround(loaded) : whole;
  if (joined(between_, least) == between_) return false;
  between_ = widened(least, (least.high[axis_] - least.low[axis_]) / 2);
  const int length = between_.high[axis_] - between_.low[axis_];
  if (length > tuning::kMostOpen * whole.high[axis_]) between_ = whole;
  return true;
}

GridBox FreeEnds::leastAround(const GridBox& loaded) const {
  const GridBox acting = joined(loaded, held_);
  return acting.isEmpty() ? wholeOf(lattice_.size()) : widened(acting, decay_);
}

// Along the block, all across it.
GridBox FreeEnds::widened(const GridBox& box, int points) const {
  GridBox wide = wholeOf(lattice_.size());
  wide.low[axis_] = std::max(wide.low[axis_], box.low[axis_] - points);
  wide.high[axis_] = std::min(wide.high[axis_], box.high[axis_] + points);
  return wide;
}

void moveEnds(const Lattice& lattice, const GridBox& between, std::vector<Vec3>& displacement) {
  const GridBox whole = wholeOf(lattice.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool at_high : {false, true}) {
      const int last = at_high ? between.high[axis] : between.low[axis];
      if (last == (at_high ? whole.high[axis] : whole.low[axis])) continue;
      GridBox begin = whole, end = whole;
      begin.low[axis] = begin.high[axis] = last;
      (at_high ? end.low[axis] : end.high[axis]) = at_high ? last + 1 : last - 1;
      const Eigen::Isometry3d motion = motionOf(lattice, begin, displacement);
      const bool turns = motion.linear() != Eigen::Matrix3d::Identity();
      forPoints(lattice, end, [&](int node) {
        const Vec3& rest = lattice.restPosition(node);
        displacement[at(node)] = turns ? Vec3(motion * rest - rest) : Vec3(motion.translation());
      });
    }
  }
}

}  // namespace robot_tissue
