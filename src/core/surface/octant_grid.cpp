#include "surface/octant_grid.h"

#include <algorithm>

namespace robot_tissue {
namespace {

// Corners of each side in the order -x +x -y +y -z +z.
constexpr int kSideCorners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

bool isNode(const HalfPoint& point) { return ((point[0] | point[1] | point[2]) & 1) == 0; }

}  // namespace

bool holdTheSame(const Hold& a, const Hold& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& one, const auto& other) { return one.node == other.node; });
}

std::array<HalfPoint, 4> cornersOfSide(const HalfPoint& lowest, int side, int length) {
  std::array<HalfPoint, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = kSideCorners[side][i] >> axis & 1;
      corners[i][at(axis)] = lowest[at(axis)] + length * bit;
    }
  }
  return corners;
}

OctantGrid::OctantGrid(const Lattice& lattice, const LatticeState& state)
    : lattice_(lattice),
      state_(state),
      parts_(lattice, state),
      open_(lattice.cells().size(), 0),
      divisions_(lattice, state) {
  placeCells();
  if (isAsMade(state)) return;
  for (std::size_t cell = 0; cell < open_.size(); ++cell) {
    open_[cell] = parts_.isOpen(static_cast<int>(cell)) ? 1 : 0;
  }
}

void OctantGrid::placeCells() {
  const auto& size = lattice_.size();
  row_ = size[0] + 2;
  plane_ = row_ * (size[1] + 2);
  cell_at_.assign(at(plane_ * (size[2] + 2)), -1);
  for (const Cell& cell : lattice_.cells()) {
    const auto low = lattice_.gridIndex(cell.nodes.front());
    cell_at_[at(low[0] + 1 + row_ * (low[1] + 1) + plane_ * (low[2] + 1))] = cell.place;
  }
}

int OctantGrid::nodeOf(const Octant& octant) const {
  return lattice_.cells()[at(octant.cell)].nodes[at(octant.corner)];
}

HalfPoint OctantGrid::lowestOf(const Octant& octant) const {
  HalfPoint lowest = lattice_.gridIndex(lattice_.cells()[at(octant.cell)].nodes.front());
  for (int axis = 0; axis < 3; ++axis) {
    lowest[at(axis)] = 2 * lowest[at(axis)] + (octant.corner >> axis & 1);
  }
  return lowest;
}

Octant OctantGrid::octantAt(const HalfPoint& lowest) const {
  if (std::any_of(lowest.begin(), lowest.end(), [](int index) { return index < 0; })) return {};
  Octant octant;
  octant.cell = cellAt({lowest[0] / 2, lowest[1] / 2, lowest[2] / 2});
  for (int axis = 0; axis < 3; ++axis) octant.corner |= (lowest[at(axis)] & 1) << axis;
  return octant;
}

Octant OctantGrid::beyond(const Octant& octant, int side) const {
  const int axis = side / 2;
  const bool inwards = (octant.corner >> axis & 1) != side % 2;
  if (inwards) return {octant.cell, octant.corner ^ 1 << axis};
  HalfPoint lowest = lowestOf(octant);
  lowest[at(axis)] += side % 2 == 1 ? 1 : -1;
  return octantAt(lowest);
}

CellPoint OctantGrid::inCell(int cell, const HalfPoint& point) const {
  const auto low = lattice_.gridIndex(lattice_.cells()[at(cell)].nodes.front());
  CellPoint from_low{};
  for (std::size_t axis = 0; axis < 3; ++axis) from_low[axis] = point[axis] - 2 * low[axis];
  return from_low;
}

// From the cell's lowest corner, in spacings.
Vec3 OctantGrid::placeInCell(const Octant& octant, const HalfPoint& point) const {
  const CellPoint from_low = inCell(octant.cell, point);
  if (const CellDivision* division = divisions_.find(octant.cell)) return division->at(from_low);
  return 0.5 * Vec3(from_low[0], from_low[1], from_low[2]);
}

// Of the octant's cell.
int OctantGrid::cornerAt(const Octant& octant, const HalfPoint& node) const {
  const auto low = lattice_.gridIndex(lattice_.cells()[at(octant.cell)].nodes.front());
  int corner = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (node[at(axis)] > 2 * low[at(axis)]) corner |= 1 << axis;
  }
  return corner;
}

Hold OctantGrid::holdOf(const Octant& octant, const HalfPoint& point) const {
  const Cell& part = *parts_.owner(octant.cell, octant.corner);
  Hold hold;
  if (isNode(point)) {
    hold.add(part.nodes[at(cornerAt(octant, point))], 1.0);
    return hold;
  }
  const Vec3 place = placeInCell(octant, point);
  for (int corner = 0; corner < kCorners; ++corner) {
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      weight *= (corner >> axis & 1) != 0 ? place[axis] : 1.0 - place[axis];
    }
    if (weight > 0.0) hold.add(part.nodes[at(corner)], weight);
  }
  std::sort(hold.carriers.begin(), hold.carriers.begin() + hold.count,
            [](const auto& one, const auto& other) { return one.node < other.node; });
  return hold;
}

bool OctantGrid::isJoined(const Octant& octant, int side) const {
  const Octant other = beyond(octant, side);
  if (!isThere(octant) || !isThere(other)) return false;
  if (other.cell != octant.cell) return true;  // of one node
  // The cell's inside point is a corner of the side, and hangs on all of a part's nodes.
  return parts_.owner(octant.cell, octant.corner)->nodes ==
         parts_.owner(other.cell, other.corner)->nodes;
}

Vec3 OctantGrid::placeOf(const Octant& octant, const HalfPoint& point) const {
  const auto low = lattice_.gridIndex(lattice_.cells()[at(octant.cell)].nodes.front());
  const Vec3 place = Vec3(low[0], low[1], low[2]) + placeInCell(octant, point);
  return lattice_.bounds().min() + lattice_.spacing() * place;
}

}  // namespace robot_tissue
