// What a solve does to the loading patches: where those by force went, and what all of them bear.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "solvers/multigrid/cycle/solve_context.h"
#include "solvers/multigrid/level/constrained_nodes.h"

namespace robot_tissue {

// Moves patches by force, as rigid bodies, by these motions (spacings, rad). How far one turned at
// most (rad); absent: none moved.
std::optional<double> movePatches(const Lattice& lattice, const std::vector<GroupVector>& motions,
                                  ConstrainedState& shape);

struct PatchAnswers {
  std::vector<PatchAnswer> all;
  double greatest = 0.0;  // force on a node: hard, at a rim or in contact (N)
};
// forceOn(node): all that acts on a hard node but the patch (N).
PatchAnswers answersOf(const Lattice& lattice, const SolveContext& solve,
                       const std::function<Vec3(int)>& forceOn);

}  // namespace robot_tissue
