#include "tissue/surgery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/blade_surface.h"
#include "cutting/crumbs.h"
#include "cutting/cut.h"
#include "cutting/cut_front.h"
#include "cutting/tear.h"
#include "material/tissue_model.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {
Surgery::Surgery(const TissueConfig& tissue, TissueData& data, LoadStepSolver& solver)
    : data_(data), solver_(solver), tear_strains_(tearStrains(data.body.lattice(), tissue)) {}

// Balances what other cells and springs leave. Until contacts are renewed, tools' springs are of
// the nodes that there were.
SolveReport Surgery::changeTopology(const std::vector<int>& disturbed) {
  const double before_ms = data_.bounds.leftMs();
  data_.body.change();
  data_.loads.loseParted(data_.body.cells());
  data_.outcome.is_as_solved = false;
  data_.motion.noteOtherCells();
  data_.rebuildSurface();
  data_.deformSurface(
      [](const ContactSpring&, const std::vector<Vec3>&) -> Vec3 { return Vec3::Zero(); });
  solver_.renewContacts();
  if (data_.motion.takesNoTime()) return data_.asItIs();
  if (hasTimeForLevels(before_ms)) return solver_.solve(disturbed);
  return leaveToNextCall(disturbed);
}

// before_ms: what was left before the surface was made.
bool Surgery::hasTimeForLevels(double before_ms) const {
  const double left_ms = data_.bounds.leftMs();
  if (!data_.bounds.isBounded() || !std::isfinite(left_ms)) return true;
  return left_ms >= tuning::kLevelsOverSurface * (before_ms - left_ms);
}

// The shape stays, to be balanced by the next solve.
SolveReport Surgery::leaveToNextCall(const std::vector<int>& disturbed) {
  SolveOutcome& outcome = data_.outcome;
  outcome.disturb(disturbed);
  outcome.forgetGhosts(data_.body.cells());
  outcome.is_late = true;
  outcome.worsen(SolveStatus::kLate);
  outcome.report.iterations = 0;
  outcome.report.wall_ms = 0.0;
  outcome.report.volume_ratio = data_.body.volumeRatio();
  return outcome.report;
}

// Nodes round a mesh are up to a cell's diagonal off its surface.
bool Surgery::mayReach(const Box& bounds) const {
  return grownBy(tuning::kNodesBeyondSurface * data_.body.lattice().spacing(), data_.body.bounds())
      .intersects(bounds);
}

// Severs the springs and balances what they leave. Tissue that may tear has cuts that end at the
// last springs severed, as tears do: what tears next is told by the strain there.
SolveReport Surgery::severAndBalance(const std::vector<Crossing>& crossings,
                                     const BladeSurface* blade) {
  Body& body = data_.body;
  const Lattice& lattice = body.lattice();
  std::vector<int> disturbed;
  for (const Crossing& crossing : crossings) {
    disturbed.push_back(lattice.springs()[at(crossing.spring)].a);
    disturbed.push_back(lattice.springs()[at(crossing.spring)].b);
  }
  const int pieces_before = body.state().pieces;
  const std::vector<int> touched = data_.pieces.touched();
  if (blade != nullptr && tear_strains_.empty()) {
    sever(lattice, crossings, *blade, body.change(), body.model().splitCells());
  } else {
    sever(lattice, crossings, body.change(), body.model().splitCells());
  }
  if (body.state().pieces != pieces_before) data_.pieces.renumber();
  dropFreed(touched);
  return changeTopology(disturbed);
}

// The blade severs nothing, but what is ahead of it bears less.
SolveReport Surgery::goNearer(std::vector<SpringAhead> ahead) {
  const TopologyChange change(data_, History::Kind::kStrokeGoesOn);
  data_.body.setAhead(std::move(ahead));
  data_.renewTies();
  std::vector<int> disturbed;
  for (const SpringAhead& each : data_.body.state().ahead) {
    disturbed.push_back(data_.body.lattice().springs()[at(each.spring)].a);
    disturbed.push_back(data_.body.lattice().springs()[at(each.spring)].b);
  }
  return data_.motion.takesNoTime() ? data_.asItIs() : solver_.solve(disturbed);
}

CutReport Surgery::cut(const std::vector<Vec3>& corners) {
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  const std::vector<Crossing> crossing =
      sparingCrumbs(lattice, state, springsAcross(lattice, state, corners));
  CutReport report;
  report.springs_cut = static_cast<int>(crossing.size());
  report.pieces = state.pieces;
  report.solve = data_.outcome.report;
  if (crossing.empty()) return report;
  const TopologyChange change(data_, History::Kind::kByItself);
  const int torn = springs_torn_;
  const BladeSurface blade = BladeSurface::of(corners, lattice.spacing());
  severAndBalance(crossing, &blade);
  report.solve = tear();
  report.springs_torn = springs_torn_ - torn;
  report.pieces = state.pieces;
  return report;
}

CutReport Surgery::cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke) {
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  CutReport report;
  report.pieces = state.pieces;
  report.solve = data_.outcome.report;
  const BladeSurface surface(swept, lattice.spacing());
  if (!mayReach(surface.bounds())) return report;
  const std::vector<Crossing> crossings =
      sparingCrumbs(lattice, state, surface.crossings(lattice, state));
  if (crossings.empty()) {
    if (stroke == Stroke::kBegins || state.ahead.empty()) return report;
    std::vector<SpringAhead> ahead = springsAhead(lattice, state, surface, {});
    if (haveComeNearer(state.ahead, ahead)) report.solve = goNearer(std::move(ahead));
    return report;
  }
  for (const Crossing& crossing : crossings) {
    report.center += crossing.point / static_cast<double>(crossings.size());
  }
  report.springs_cut = static_cast<int>(crossings.size());
  report.area = newSurface(lattice, crossings);
  const TopologyChange change(
      data_, stroke == Stroke::kBegins ? History::Kind::kByItself : History::Kind::kStrokeGoesOn);
  const int torn = springs_torn_;
  severAndBalance(crossings, &surface);
  report.solve = tear();
  report.springs_torn = springs_torn_ - torn;
  report.pieces = state.pieces;
  return report;
}

}  // namespace robot_tissue
