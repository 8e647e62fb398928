#include "surface/cut_region.h"

#include <algorithm>

#include "surface/mesh_surface.h"

namespace robot_tissue {
namespace {

constexpr int kNotLookedForYet = -2;  // a cell; -1: none

}  // namespace

CutRegion::CutRegion(const Lattice& lattice, const CellParts& parts) : lattice_(lattice) {
  std::vector<Octants> open;
  for (const Cell& cell : lattice.cells()) {
    if (parts.isOpen(cell.place)) open.push_back(octantsAround(cell));
  }
  if (open.empty()) return;
  Octants box = open.front();
  for (const Octants& each : open) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.first[axis] = std::min(box.first[axis], each.first[axis]);
      box.last[axis] = std::max(box.last[axis], each.last[axis]);
    }
  }
  cell_of_ = OnOctants<int>(box.first, box.last, kNotLookedForYet);
  is_in_ = OnOctants<char>(box.first, box.last, 0);
  for (const Octants& each : open) add(each);
  std::sort(octants_.begin(), octants_.end());
}

CutRegion::Octants CutRegion::octantsAround(const Cell& cell) const {
  const auto lowest = lattice_.gridIndex(cell.nodes.front());
  Octants around;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int cells = lattice_.size()[axis] - 1;
    around.first[axis] = std::max(0, 2 * lowest[axis] - 2);
    around.last[axis] = std::min(2 * cells - 1, 2 * lowest[axis] + 3);
  }
  return around;
}

void CutRegion::add(const Octants& octants) {
  for (int k = octants.first[2]; k <= octants.last[2]; ++k) {
    for (int j = octants.first[1]; j <= octants.last[1]; ++j) {
      for (int i = octants.first[0]; i <= octants.last[0]; ++i) {
        char& is_in = *is_in_.find({i, j, k});
        if (is_in == 0) octants_.push_back({i, j, k});
        is_in = 1;
      }
    }
  }
}

bool CutRegion::reachesInto(const HalfIndex& first, const HalfIndex& last) const {
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int i = first[0]; i <= last[0]; ++i) {
        if (has({i, j, k})) return true;
      }
    }
  }
  return false;
}

int CutRegion::cellOf(const HalfIndex& octant) {
  int* known = cell_of_.find(octant);
  if (known != nullptr && *known != kNotLookedForYet) return *known;
  int cell = lattice_.cellAt({octant[0] / 2, octant[1] / 2, octant[2] / 2});
  const Vec3 middle(octant[0] + 0.5, octant[1] + 0.5, octant[2] + 0.5);
  if (cell < 0) cell = nearestCell(lattice_, 0.5 * middle);
  if (known != nullptr) *known = cell;
  return cell;
}

int CutRegion::cornerOf(int cell, const HalfIndex& octant) const {
  const auto lowest = lattice_.gridIndex(lattice_.cells()[at(cell)].nodes.front());
  int corner = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int node = (octant[at(axis)] + 1) / 2;
    if (node > lowest[at(axis)]) corner |= 1 << axis;
  }
  return corner;
}

}  // namespace robot_tissue
