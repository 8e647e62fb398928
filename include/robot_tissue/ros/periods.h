// What the node does so often, and a replay as the node. Chosen.
#pragma once

namespace robot_tissue {

// s: between looks at what is wrong, or still to be done, while nothing comes. More: a scene that
// stands costs less; a robot that is lost is told of later.
constexpr double kWatchPeriod = 0.1;
// s: between two states, or lists of contacts, while nothing changes. More: who comes later waits
// for longer.
constexpr double kStatePeriod = 1.0;

}  // namespace robot_tissue
