// What cells that are filled in part reach beyond their faces (CellReach; own).
#pragma once

#include <array>

#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Whether the side of `corners` is that of `other` opposite to it.
inline bool haveInCommon(const std::array<int, kCorners>& corners, int side,
                         const std::array<int, kCorners>& other) {
  for (int r = 0; r < kFaceNodes; ++r) {
    if (other[at(faceCorner(side ^ 1, r))] != corners[at(faceCorner(side, r))]) return false;
  }
  return true;
}

// `share`: of h^3; null nodes: there is none.
struct NeighborCell {
  const std::array<int, kCorners>* nodes = nullptr;
  double share = 0.0;
};

// Null: of no neighbor. `share`: of h^3, the cell's own. across(side): the NeighborCell there.
template <typename Across>
SharedConst<CellReach> reachOf(double share, const Across& across) {
  CellReach reach;
  reach.nodes.fill(-1);
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, 2> shares{};
    for (const int up : {0, 1}) {
      const int side = 2 * axis + up;
      const NeighborCell neighbor = across(side);
      if (neighbor.nodes == nullptr) continue;
      any = true;
      shares[at(up)] = neighbor.share;
      for (int r = 0; r < kFaceNodes; ++r) {
        reach.nodes[at(kFaceNodes * side + r)] = (*neighbor.nodes)[at(faceCorner(side, r))];
      }
    }
    reach.weigh(axis, share, shares[0], shares[1]);
  }
  return any ? SharedConst<CellReach>(reach) : SharedConst<CellReach>();
}

}  // namespace robot_tissue
