#include "solvers/multigrid/hierarchy/open_parts.h"

#include <algorithm>

#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

int countOf(const GridBox& box) {
  return (box.high[0] - box.low[0] + 1) * (box.high[1] - box.low[1] + 1) *
         (box.high[2] - box.low[2] + 1);
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

}  // namespace

GridBox around(const GridBox& box, int layers) {
  GridBox wider = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wider.low[axis] -= layers;
    wider.high[axis] += layers;
  }
  return wider;
}

std::vector<GridBox> openPartsAround(const std::vector<LevelSource>& sources, const GridBox& box,
                                     int layers) {
  std::vector<GridBox> free;
  GridBox wanted = box;
  for (std::size_t level = 0; level < sources.size(); ++level) {
    const LevelSource& source = sources[level];
    const bool has_coarser = level + 1 < sources.size() && sources[level + 1].isThick();
    if (!source.rough.isEmpty())
      wanted = joined(wanted, around(source.rough, tuning::kBesideRough));
    wanted = joined(wanted, source.listed.box);
    free.push_back(has_coarser ? fitted(wanted, source.whole()) : source.whole());
    wanted = around(coveredBy(free.back(), source.whole()), layers);
  }
  return free;
}

GridBox withNeighbors(const GridBox& free, const GridBox& whole) {
  GridBox points = around(free, 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    points.low[axis] = std::max(points.low[axis], 0);
    points.high[axis] = std::min(points.high[axis], whole.high[axis]);
  }
  return points;
}

GridBox coveredBy(const GridBox& free, const GridBox& whole) {
  GridBox covered;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool to_the_end = free.high[axis] == whole.high[axis];
    covered.low[axis] = (free.low[axis] + 1) / 2;
    covered.high[axis] = (free.high[axis] + (to_the_end ? 1 : 0)) / 2;
  }
  return covered;
}

}  // namespace robot_tissue
