// Which part of each level of a block is open, that is, solved for: wider from level to level, so
// that the spacing doubles with the distance (multilevel adaptive technique: Brandt 1977). Boxes
// are in points of a level's whole grid.
#pragma once

#include <vector>

#include "solvers/multigrid/hierarchy/level_source.h"
#include "solvers/multigrid/level/grid_level.h"

namespace robot_tissue {

// The box and so many points more to all sides.
GridBox around(const GridBox& box, int layers);

// Per level, nodes that may move: the least part of the finest that has the box, then on each
// coarser level what the finer one covers and so many layers beyond. All of a level where its part
// were little less; from there on the coarser levels are whole, too.
std::vector<GridBox> openPartsAround(const std::vector<LevelSource>& sources, const GridBox& box,
                                     int layers);

// The nodes that may move and those next to them, of the whole grid.
GridBox withNeighbors(const GridBox& free, const GridBox& whole);

// Coarse nodes whose fine ones, those next to them too, may all move.
GridBox coveredBy(const GridBox& free, const GridBox& whole);

// Of the finest level: there is no finer one that covers it.
constexpr GridBox kCoversNothing = {{1}, {0}};

}  // namespace robot_tissue
