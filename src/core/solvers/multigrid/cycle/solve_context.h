// One solve: what it is given, and what it has cost so far.
#pragma once

#include <algorithm>

#include "loads/constrained_state.h"
#include "loads/dof_constraints.h"
#include "solvers/multigrid/cycle/budget.h"

namespace robot_tissue {

struct SolveContext {
  ConstrainedState& shape;
  const DofConstraints& hold;  // bound to it
  const Budget& budget;
  bool in_contact = false;
  bool in_time = false;  // a time step
  // There are contacts or disturbed nodes. What they change may be too small to show in the error,
  // which is relative to the displacement: at least one cycle is made.
  bool has_changed = false;
  bool warm_started = false;  // moved along the last step, before the first cycle
  int cycles = 0;
};

// What is renewed seldom is renewed in these cycles: 1, 2, 4, 8, and so on.
inline bool isPowerOfTwo(int cycle) { return (cycle & (cycle - 1)) == 0; }

// Whether a tool or support touches. Threads count as tissue: they hold on, and need no rounds.
inline bool isInContact(const ConstrainedState& shape) {
  return std::any_of(shape.patches.begin(), shape.patches.end(), [](const LoadingPatch& patch) {
    return !patch.contacts.empty() && !patch.contacts[0].is_thread;
  });
}

}  // namespace robot_tissue
