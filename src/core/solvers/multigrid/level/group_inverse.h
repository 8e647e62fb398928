// What balances a patch that a force drives: how it moves, and turns, by a force and a moment on
// it.
#pragma once

#include <Eigen/Core>

namespace robot_tissue {

using GroupMatrix = Eigen::Matrix<double, 6, 6>;

// The inverse of a patch's stiffness: shifts (spacings), then turns (rad). Directions in which it
// has none count as stiff where it does not turn. One that turns does not go where it has none, as
// about a line of nodes, which its nodes on a coarse lattice may be.
GroupMatrix inverseOfGroup(GroupMatrix stiffness, bool turns);

}  // namespace robot_tissue
