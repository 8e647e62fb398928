// What cells that are filled in part reach beyond their faces (CellReach; own).
#pragma once

#include <array>
#include <memory>

#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Whether the side of `corners` is that of `other` opposite to it.
inline bool haveInCommon(const std::array<int, kCorners>& corners, int axis, int side,
                         const std::array<int, kCorners>& other) {
  for (int r = 0; r < kFaceNodes; ++r) {
    if (other[at(faceCorner(axis, -side, r))] != corners[at(faceCorner(axis, side, r))]) {
      return false;
    }
  }
  return true;
}

// The nodes opposite a face, of a cell with this one in common; false: there is none.
// `visit_cells(node, visit)` calls visit(corners) for all cells that have the node, until it
// returns true.
template <typename VisitCells>
bool findBeyond(const std::array<int, kCorners>& corners, int axis, int side,
                const VisitCells& visit_cells, int* beyond) {
  bool found = false;
  visit_cells(corners[at(faceCorner(axis, side, 0))], [&](const std::array<int, kCorners>& other) {
    found = haveInCommon(corners, axis, side, other);
    for (int r = 0; found && r < kFaceNodes; ++r) {
      beyond[r] = other[at(faceCorner(axis, side, r))];
    }
    return found;
  });
  return found;
}

// Along each axis of the neighbor that the fill's centroid is towards, where there is one; else of
// the one opposite. Null: of none.
template <typename VisitCells>
std::shared_ptr<const CellReach> reachAmong(const std::array<int, kCorners>& corners,
                                            const Vec3& centroid, const VisitCells& visit_cells) {
  constexpr double kRounding = 1e-6;  // of the spacing
  CellReach reach;
  reach.nodes.fill(-1);
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const int towards = centroid[axis] < -kRounding ? -1 : 1;
    for (const int side : {towards, -towards}) {
      std::array<int, kFaceNodes> beyond{};
      if (!findBeyond(corners, axis, side, visit_cells, beyond.data())) continue;
      reach.side[at(axis)] = side;
      std::copy(beyond.begin(), beyond.end(), reach.nodes.begin() + kFaceNodes * axis);
      any = true;
      break;
    }
  }
  return any ? std::make_shared<const CellReach>(reach) : nullptr;
}

}  // namespace robot_tissue
