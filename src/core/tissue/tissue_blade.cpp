// Tissue: springs that blades cut, and those that tear.
#include <algorithm>
#include <optional>
#include <utility>

#include "cutting/blade_surface.h"
#include "cutting/crumbs.h"
#include "cutting/cut.h"
#include "cutting/cut_front.h"
#include "cutting/tear.h"
#include "material/tissue_model.h"
#include "tissue/tissue_parts.h"
#include "tissue/solve_total.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {

// Nodes round a mesh are up to a cell's diagonal off its surface.
bool TissueParts::mayReach(const Box& bounds) const {
  return grownBy(tuning::kNodesBeyondSurface * lattice_.spacing(), bounds_).intersects(bounds);
}

// Severs the springs and balances what they leave. Tissue that may tear has cuts that end at the
// last springs severed, as tears do: what tears next is told by the strain there.
SolveReport TissueParts::severAndBalance(const std::vector<Crossing>& crossings,
                                         const BladeSurface* blade) {
  std::vector<int> disturbed;
  for (const Crossing& crossing : crossings) {
    disturbed.push_back(lattice_.springs()[at(crossing.spring)].a);
    disturbed.push_back(lattice_.springs()[at(crossing.spring)].b);
  }
  const int pieces_before = state_.pieces;
  if (blade != nullptr && tear_strains_.empty()) {
    sever(lattice_, crossings, *blade, state_, model_->splitCells());
  } else {
    sever(lattice_, crossings, state_, model_->splitCells());
  }
  if (state_.pieces != pieces_before) renumberPieces();
  dropFreed();
  return changeTopology(disturbed);
}

// The blade severs nothing, but what is ahead of it bears less.
SolveReport TissueParts::goNearer(std::vector<SpringAhead> ahead) {
  const TopologyChange change(*this, History::Kind::kStrokeGoesOn);
  state_.ahead = std::move(ahead);
  renewTies();
  std::vector<int> disturbed;
  for (const SpringAhead& each : state_.ahead) {
    disturbed.push_back(lattice_.springs()[at(each.spring)].a);
    disturbed.push_back(lattice_.springs()[at(each.spring)].b);
  }
  return takesNoTime() ? asItIs() : solve(disturbed);
}

CutReport TissueParts::cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke) {
  CutReport report;
  report.pieces = state_.pieces;
  report.solve = last_report_;
  const BladeSurface surface(swept, lattice_.spacing());
  if (!mayReach(surface.bounds())) return report;
  const std::vector<Crossing> crossings =
      sparingCrumbs(lattice_, state_, surface.crossings(lattice_, state_));
  if (crossings.empty()) {
    if (stroke == Stroke::kBegins || state_.ahead.empty()) return report;
    std::vector<SpringAhead> ahead = springsAhead(lattice_, state_, surface, {});
    if (haveComeNearer(state_.ahead, ahead)) report.solve = goNearer(std::move(ahead));
    return report;
  }
  for (const Crossing& crossing : crossings) {
    report.center += crossing.point / static_cast<double>(crossings.size());
  }
  report.springs_cut = static_cast<int>(crossings.size());
  report.area = newSurface(lattice_, crossings);
  const TopologyChange change(
      *this, stroke == Stroke::kBegins ? History::Kind::kByItself : History::Kind::kStrokeGoesOn);
  const int torn = springs_torn_;
  severAndBalance(crossings, &surface);
  report.solve = tear();
  report.springs_torn = springs_torn_ - torn;
  report.pieces = state_.pieces;
  return report;
}

bool TissueParts::tearOut(const std::vector<int>& nodes) {
  std::vector<std::uint8_t> goes(at(lattice_.nodeCount()), 0);
  for (const int node : nodes) goes[at(state_.cells->original(node))] = 1;
  std::vector<int> around;
  for (const Spring ends : lattice_.springs()) {
    const bool parts = goes[at(ends.a)] != goes[at(ends.b)] && state_.severed[at(ends.number)] == 0;
    if (parts) around.push_back(ends.number);
  }
  const std::vector<Crossing> crossings = sparingCrumbs(lattice_, state_, halfWay(around));
  if (crossings.empty()) return false;
  const TopologyChange change(*this, History::Kind::kTear);
  springs_torn_ += static_cast<int>(crossings.size());
  severAndBalance(crossings);
  tear();
  return true;
}

// In time the shape gives way by and by: what goes next is seen after the next step.
SolveReport TissueParts::tear() {
  dropLetGo();
  if (tear_strains_.empty()) return last_report_;
  SolveTotal total(last_report_);
  bool any = false;
  std::optional<TopologyChange> change;
  for (int round = 0; !isLate(); ++round) {
    const std::vector<Crossing> weakest = tearingNext(lattice_, state_, tear_strains_);
    if (weakest.empty()) break;
    if (round == tuning::kMostTearRounds || (any && deadline_ && deadline_->isOver())) {
      is_late_ = true;
      total.worsen(SolveStatus::kLate);
      break;
    }
    if (patience_.cutsOff() && last_report_.status == SolveStatus::kUnconverged) break;
    if (!any) change.emplace(*this, History::Kind::kTear);
    any = true;
    springs_torn_ += static_cast<int>(weakest.size());
    const SolveReport round_report = severAndBalance(weakest);
    if (takesNoTime()) break;
    total.add(round_report);
  }
  if (!any) return last_report_;
  total.tellIn(last_report_);
  return last_report_;
}

}  // namespace robot_tissue
