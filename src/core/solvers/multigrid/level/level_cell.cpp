#include "solvers/multigrid/level/level_cell.h"

#include <unordered_map>

#include "lattice/cell_reach.h"

namespace robot_tissue {

std::shared_ptr<const LevelFill> levelFill(const CellFill& fill, double shear_where_full,
                                           double bulk_where_full) {
  auto level = std::make_shared<LevelFill>();
  level->integrals = integralsOf(fill).scaledBy(shear_where_full);
  level->law = fillLaw(fill, bulk_where_full / shear_where_full);
  return level;
}

void findReaches(std::vector<LevelCell>& cells) {
  std::unordered_map<int, std::vector<const LevelCell*>> cells_at;
  for (const LevelCell& cell : cells) {
    if (cell.fill == nullptr) continue;
    for (const int node : cell.nodes) cells_at[node];
  }
  if (cells_at.empty()) return;
  for (const LevelCell& cell : cells) {
    for (const int node : cell.nodes) {
      const auto asked = cells_at.find(node);
      if (asked != cells_at.end()) asked->second.push_back(&cell);
    }
  }
  for (LevelCell& cell : cells) {
    if (cell.fill == nullptr) continue;
    cell.reach = reachOf(cell.shear, [&](int side) -> NeighborCell {
      for (const LevelCell* other : cells_at.at(cell.nodes[at(faceCorner(side, 0))])) {
        if (haveInCommon(cell.nodes, side, other->nodes)) {
          return {&other->nodes, other->shear};
        }
      }
      return {};
    });
  }
}

}  // namespace robot_tissue
