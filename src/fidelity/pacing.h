// The steps of a scene cut in updates: what a tool moves between two of them. The same at every
// spacing, so that their costs can be compared.
#pragma once

#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Loads and moves with `increments` keep them as updates; the others get as many as their way takes
// at `way_an_update` (m). An update of a load is solved in parts of half a spacing at most, the
// longest motion that methods follow well; a move is walked in load steps by itself. Only loads,
// moves and pushes are timed; where there are none, every step is.
struct PacedScene {
  Scene scene;
  std::vector<int> parts;  // per step: increments that make one update; 0: none that is timed
};

PacedScene paced(const Scene& scene, double way_an_update);

// How many updates all the steps have.
int updateCount(const PacedScene& paced);

}  // namespace robot_tissue
