// Surgery: springs that tear.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "cutting/crumbs.h"
#include "cutting/cut.h"
#include "cutting/tear.h"
#include "tissue/solve_total.h"
#include "tissue/surgery.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {

bool Surgery::tearOut(const std::vector<int>& nodes) {
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  std::vector<std::uint8_t> goes(at(lattice.nodeCount()), 0);
  for (const int node : nodes) goes[at(data_.body.cells().original(node))] = 1;
  std::vector<int> around;
  for (const Spring ends : lattice.springs()) {
    const bool parts = goes[at(ends.a)] != goes[at(ends.b)] && state.severed[at(ends.number)] == 0;
    if (parts) around.push_back(ends.number);
  }
  const std::vector<Crossing> crossings = sparingCrumbs(lattice, state, halfWay(around));
  if (crossings.empty()) return false;
  const TopologyChange change(data_, History::Kind::kTear);
  springs_torn_ += static_cast<int>(crossings.size());
  severAndBalance(crossings);
  tear();
  return true;
}

bool Surgery::isOverstretched() const {
  if (tear_strains_.empty()) return false;
  return !tearingNext(data_.body.lattice(), data_.body.state(), tear_strains_).empty();
}

// In time the shape gives way by and by: what goes next is seen after the next step.
SolveReport Surgery::tear() {
  SolveOutcome& outcome = data_.outcome;
  dropLetGo();
  if (tear_strains_.empty() || data_.loads.areComingBack()) return outcome.report;
  SolveTotal total(outcome.report);
  bool any = false;
  std::optional<TopologyChange> change;
  for (int round = 0; !data_.isLate(); ++round) {
    const std::vector<Crossing> weakest =
        tearingNext(data_.body.lattice(), data_.body.state(), tear_strains_);
    if (weakest.empty()) break;
    if (round == tuning::kMostTearRounds || (any && data_.bounds.isTimeOver())) {
      outcome.is_late = true;
      total.worsen(SolveStatus::kLate);
      break;
    }
    const bool is_none = outcome.report.status == SolveStatus::kUnconverged;
    if (is_none && data_.bounds.patience().cutsOff()) break;
    if (!any) change.emplace(data_, History::Kind::kTear);
    any = true;
    springs_torn_ += static_cast<int>(weakest.size());
    const SolveReport round_report = severAndBalance(weakest);
    if (data_.motion.takesNoTime()) break;
    total.add(round_report);
  }
  if (!any) return outcome.report;
  total.tellIn(outcome.report);
  return outcome.report;
}

}  // namespace robot_tissue
