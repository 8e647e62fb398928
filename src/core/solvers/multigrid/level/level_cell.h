// The cells of a level (own).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "material/fill_law.h"
#include "robot_tissue/core/cells.h"

namespace robot_tissue {

// Of a cell that is filled in part.
struct LevelFill {
  FillIntegrals integrals;  // over what is in it, times the shear modulus there (E0)
  FillLaw law;
  Vec3 between_parts = Vec3::Zero();  // of a coarse cell: variance of its parts' centroids (h^2)
};

// Of a cell of these moduli (E0), filled so where it is full.
std::shared_ptr<const LevelFill> levelFill(const CellFill& fill, double shear_where_full,
                                           double bulk_where_full);

// A cell of a level: its lowest grid point, its corners' entries in the level's fields, moduli.
struct LevelCell {
  std::array<int, 3> place{};
  std::array<int, kCorners> nodes{};
  double shear = 0.0;
  double bulk = 0.0;
  double stiffening = 0.0;                // of the law `fung` (material/elastic_law.h)
  std::shared_ptr<const LevelFill> fill;  // null: full
  // Of one that is filled in part, as Cell::reach, by entries; null: no neighbor.
  SharedConst<CellReach> reach;
};

// Gives the cells that are filled in part what they reach of each other, and of all others.
void findReaches(std::vector<LevelCell>& cells);

}  // namespace robot_tissue
