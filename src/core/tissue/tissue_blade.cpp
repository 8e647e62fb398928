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
#include "tissue/solve_total.h"
#include "tissue/tissue_parts.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {

// Nodes round a mesh are up to a cell's diagonal off its surface.
bool TissueParts::mayReach(const Box& bounds) const {
  return grownBy(tuning::kNodesBeyondSurface * body_.lattice().spacing(), body_.bounds())
      .intersects(bounds);
}

// Severs the springs and balances what they leave. Tissue that may tear has cuts that end at the
// last springs severed, as tears do: what tears next is told by the strain there.
SolveReport TissueParts::severAndBalance(const std::vector<Crossing>& crossings,
                                         const BladeSurface* blade) {
  std::vector<int> disturbed;
  for (const Crossing& crossing : crossings) {
    disturbed.push_back(body_.lattice().springs()[at(crossing.spring)].a);
    disturbed.push_back(body_.lattice().springs()[at(crossing.spring)].b);
  }
  const int pieces_before = body_.state().pieces;
  if (blade != nullptr && tear_strains_.empty()) {
    sever(body_.lattice(), crossings, *blade, body_.change(), body_.model().splitCells());
  } else {
    sever(body_.lattice(), crossings, body_.change(), body_.model().splitCells());
  }
  if (body_.state().pieces != pieces_before) pieces_.renumber();
  dropFreed();
  return changeTopology(disturbed);
}

// The blade severs nothing, but what is ahead of it bears less.
SolveReport TissueParts::goNearer(std::vector<SpringAhead> ahead) {
  const TopologyChange change(*this, History::Kind::kStrokeGoesOn);
  body_.setAhead(std::move(ahead));
  renewTies();
  std::vector<int> disturbed;
  for (const SpringAhead& each : body_.state().ahead) {
    disturbed.push_back(body_.lattice().springs()[at(each.spring)].a);
    disturbed.push_back(body_.lattice().springs()[at(each.spring)].b);
  }
  return motion_.takesNoTime() ? asItIs() : solve(disturbed);
}

CutReport TissueParts::cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke) {
  CutReport report;
  report.pieces = body_.state().pieces;
  report.solve = outcome_.report;
  const BladeSurface surface(swept, body_.lattice().spacing());
  if (!mayReach(surface.bounds())) return report;
  const std::vector<Crossing> crossings = sparingCrumbs(
      body_.lattice(), body_.state(), surface.crossings(body_.lattice(), body_.state()));
  if (crossings.empty()) {
    if (stroke == Stroke::kBegins || body_.state().ahead.empty()) return report;
    std::vector<SpringAhead> ahead = springsAhead(body_.lattice(), body_.state(), surface, {});
    if (haveComeNearer(body_.state().ahead, ahead)) report.solve = goNearer(std::move(ahead));
    return report;
  }
  for (const Crossing& crossing : crossings) {
    report.center += crossing.point / static_cast<double>(crossings.size());
  }
  report.springs_cut = static_cast<int>(crossings.size());
  report.area = newSurface(body_.lattice(), crossings);
  const TopologyChange change(
      *this, stroke == Stroke::kBegins ? History::Kind::kByItself : History::Kind::kStrokeGoesOn);
  const int torn = springs_torn_;
  severAndBalance(crossings, &surface);
  report.solve = tear();
  report.springs_torn = springs_torn_ - torn;
  report.pieces = body_.state().pieces;
  return report;
}

bool TissueParts::tearOut(const std::vector<int>& nodes) {
  std::vector<std::uint8_t> goes(at(body_.lattice().nodeCount()), 0);
  for (const int node : nodes) goes[at(body_.cells().original(node))] = 1;
  std::vector<int> around;
  for (const Spring ends : body_.lattice().springs()) {
    const bool parts =
        goes[at(ends.a)] != goes[at(ends.b)] && body_.state().severed[at(ends.number)] == 0;
    if (parts) around.push_back(ends.number);
  }
  const std::vector<Crossing> crossings =
      sparingCrumbs(body_.lattice(), body_.state(), halfWay(around));
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
  if (tear_strains_.empty()) return outcome_.report;
  SolveTotal total(outcome_.report);
  bool any = false;
  std::optional<TopologyChange> change;
  for (int round = 0; !isLate(); ++round) {
    const std::vector<Crossing> weakest =
        tearingNext(body_.lattice(), body_.state(), tear_strains_);
    if (weakest.empty()) break;
    if (round == tuning::kMostTearRounds || (any && bounds_.isTimeOver())) {
      outcome_.is_late = true;
      total.worsen(SolveStatus::kLate);
      break;
    }
    if (bounds_.patience().cutsOff() && outcome_.report.status == SolveStatus::kUnconverged) break;
    if (!any) change.emplace(*this, History::Kind::kTear);
    any = true;
    springs_torn_ += static_cast<int>(weakest.size());
    const SolveReport round_report = severAndBalance(weakest);
    if (motion_.takesNoTime()) break;
    total.add(round_report);
  }
  if (!any) return outcome_.report;
  total.tellIn(outcome_.report);
  return outcome_.report;
}

}  // namespace robot_tissue
