#include "robot_tissue/core/grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/tuning.h"

namespace robot_tissue {
bool NodeRange::empty() const {
  return first[0] > last[0] || first[1] > last[1] || first[2] > last[2];
}

Grid::Grid(const Box& shape, double spacing) : shape_(shape), spacing_(spacing) {
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::round((shape.max()[axis] - shape.min()[axis]) / spacing);
    size_[static_cast<std::size_t>(axis)] = static_cast<int>(cells) + 1;
  }
}

Grid::Grid(const Grid& whole, std::vector<std::uint8_t> cells)
    : shape_(whole.shape_),
      spacing_(whole.spacing_),
      size_(whole.size_),
      cells_(std::move(cells)),
      nodes_(static_cast<std::size_t>(size_[0]) * at(size_[1]) * at(size_[2]), 0) {
  for (int cell = 0; cell < cellCount(); ++cell) {
    if (cells_[at(cell)] == 0) continue;
    for (const int point : cornersOf(cell)) nodes_[at(point)] = 1;
  }
}

NodeRange Grid::nodesIn(const Box& box) const { return shrunk(pointsIn(box, 0.0)); }

bool Grid::shareNode(const NodeRange& a, const NodeRange& b) const {
  NodeRange common;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    common.first[axis] = std::max(a.first[axis], b.first[axis]);
    common.last[axis] = std::min(a.last[axis], b.last[axis]);
  }
  return !shrunk(common).empty();
}

bool Grid::holdsCell(const Box& box) const {
  const NodeRange range = pointsIn(box, 0.5);
  if (cells_.empty()) return !range.empty();
  for (int k = range.first[2]; k <= range.last[2]; ++k) {
    for (int j = range.first[1]; j <= range.last[1]; ++j) {
      for (int i = range.first[0]; i <= range.last[0]; ++i) {
        if (cells_[at(i + (size_[0] - 1) * (j + (size_[1] - 1) * k))] != 0) return true;
      }
    }
  }
  return false;
}

// Ends moved inwards to the first and last index that has a node: the smallest range with the same
// nodes.
NodeRange Grid::shrunk(const NodeRange& range) const {
  if (nodes_.empty() || range.empty()) return range;
  NodeRange found{range.last, range.first};
  bool any = false;
  for (int k = range.first[2]; k <= range.last[2]; ++k) {
    for (int j = range.first[1]; j <= range.last[1]; ++j) {
      for (int i = range.first[0]; i <= range.last[0]; ++i) {
        if (nodes_[at(i + size_[0] * (j + size_[1] * k))] == 0) continue;
        any = true;
        const std::array<int, 3> index = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          found.first[axis] = std::min(found.first[axis], index[axis]);
          found.last[axis] = std::max(found.last[axis], index[axis]);
        }
      }
    }
  }
  return any ? found : NodeRange{{0, 0, 0}, {-1, -1, -1}};
}

std::array<int, 8> Grid::cornersOf(int cell) const {
  const int row = cell / (size_[0] - 1);
  const int lowest =
      cell % (size_[0] - 1) + size_[0] * (row % (size_[1] - 1) + size_[1] * (row / (size_[1] - 1)));
  std::array<int, 8> corners{};
  for (int corner = 0; corner < 8; ++corner) {
    corners[static_cast<std::size_t>(corner)] =
        lowest + (corner & 1) + size_[0] * ((corner >> 1 & 1) + size_[1] * (corner >> 2 & 1));
  }
  return corners;
}

NodeRange Grid::pointsIn(const Box& box, double offset) const {
  NodeRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double end = size_[a] - (offset > 0.0 ? 1 : 0);  // a cell less than nodes
    const double lower =
        (box.min()[axis] - shape_.min()[axis]) / spacing_ - offset - tuning::kBoxSlack;
    const double upper =
        (box.max()[axis] - shape_.min()[axis]) / spacing_ - offset + tuning::kBoxSlack;
    range.first[a] = static_cast<int>(std::clamp(std::ceil(lower), 0.0, end));
    range.last[a] = static_cast<int>(std::clamp(std::floor(upper), -1.0, end - 1.0));
  }
  return range;
}

bool spacingFits(const Vec3& extent, double spacing) {
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = extent[axis] / spacing;
    // Written so that a spacing of 0 or NaN does not fit.
    if (!(std::round(cells) >= 1.0) ||
        !(std::abs(cells - std::round(cells)) <= tuning::kBoxSlack)) {
      return false;
    }
  }
  return true;
}

double nodeCount(const Vec3& extent, double spacing) {
  double count = 1.0;
  for (int axis = 0; axis < 3; ++axis) count *= std::round(extent[axis] / spacing) + 1.0;
  return count;
}

std::vector<double> nearestSpacings(const Vec3& extent, double spacing) {
  const double shortest = extent.minCoeff();
  const double cells = shortest / spacing;  // may be below 1
  std::vector<double> found;
  for (double n = std::max(1.0, std::ceil(cells)); n < cells + tuning::kMostTriedParts; ++n) {
    if (!spacingFits(extent, shortest / n)) continue;
    found.push_back(shortest / n);
    break;
  }
  for (double n = std::floor(cells); n >= std::max(1.0, cells - tuning::kMostTriedParts); --n) {
    if (!spacingFits(extent, shortest / n)) continue;
    found.push_back(shortest / n);
    break;
  }
  return found;
}

}  // namespace robot_tissue
