// What the last solve left behind: what it said, and what it had no time for.
#pragma once

#include <algorithm>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/solve_report.h"

namespace robot_tissue {

struct SolveOutcome {
  SolveReport report;                // of the present shape
  bool is_late = false;              // there was no time to come to balance
  bool is_as_solved = false;         // the shape is the one that the method came to last
  bool are_contacts_settled = true;  // else the shape was shown before they were
  bool is_cut_short = false;         // in a time step, there was no time to come to its end
  std::vector<int> disturbed;        // nodes that it had no time to balance

  void worsen(SolveStatus status) { report.status = std::max(report.status, status); }

  // Once something is left, ascending and each once.
  void disturb(const std::vector<int>& nodes) {
    if (disturbed.empty()) {
      disturbed = nodes;
      return;
    }
    disturbed.insert(disturbed.end(), nodes.begin(), nodes.end());
    std::sort(disturbed.begin(), disturbed.end());
    disturbed.erase(std::unique(disturbed.begin(), disturbed.end()), disturbed.end());
  }
  void dropGone(const LatticeState& state) {
    const auto is_gone = [&](int node) { return isGone(state, node); };
    disturbed.erase(std::remove_if(disturbed.begin(), disturbed.end(), is_gone), disturbed.end());
  }
  // What is left is remembered as nodes of the lattice: ghosts may go before the next solve.
  void forgetGhosts(const CellSet& cells) {
    for (int& node : disturbed) node = cells.original(node);
  }
};

}  // namespace robot_tissue
