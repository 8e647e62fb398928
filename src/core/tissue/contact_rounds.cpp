// LoadStepSolver: solves, each with a look at the contacts of the shape that it came to, until they
// are those that it was solved for.
#include <algorithm>
#include <cmath>
#include <utility>

#include "loads/driven_places.h"
#include "robot_tissue/core/part_of_way.h"
#include "tissue/load_step_solver.h"
#include "tissue/round_gain.h"
#include "tissue/solve_total.h"
#include "tissue/tuning.h"

namespace robot_tissue {

struct LoadStepSolver::Rounds {
  explicit Rounds(const Tissue::Displacements& start) : before(start), gain(start) {}

  Tissue::Displacements before;            // the shape that the last round began with
  std::vector<DrivenPlace> driven_before;  // of patches by a force, where the last round began
  RoundGain gain;
  SolveReport report;    // of all of them
  SolveReport of_round;  // of the last
  int count = 1;
  int whole = 0;  // in which the shape is the one that was solved for
};

struct LoadStepSolver::RoundShape {
  bool late = false;           // no time, or no iterations, are left for another solve
  bool hurried = false;        // the solve was cut short by the clock
  bool is_on_its_way = false;  // contacts allow a share of the solve's way alone
  bool whole = false;          // the shape is the one that was solved for, in balance
  bool spent = false;          // there is no patience for another solve
  bool last = false;           // no further solve follows, whatever the contacts are
};

SolveReport LoadStepSolver::solveInRounds(const std::vector<int>& disturbed) {
  data_.methods.now().beginStep(data_.body.state());
  if (contact_update_ == nullptr) return solveOnce(disturbed);
  Rounds rounds(data_.body.displacements());
  rounds.driven_before = drivenPlaces(data_.loads.patches());
  rounds.report = rounds.of_round = solveOnce(disturbed);
  while (endRound(rounds) == RoundDecision::kSolveAgain) {
    rounds.before.reset();  // so that the next line's copy can take its memory
    rounds.before = data_.body.displacements();
    rounds.driven_before = drivenPlaces(data_.loads.patches());
    SolveTotal total(rounds.report);
    rounds.report = rounds.of_round = solveOnce({});
    total.addWork(rounds.report);
    total.tellWorkIn(rounds.report);
    data_.outcome.report = rounds.report;
    ++rounds.count;
  }
  return rounds.report;
}

// The look at the contacts after a solve: the shape is taken back to where contacts allow it, the
// contacts are renewed, and the report tells what is left open. Where it is to be solved again, the
// patches are those for it.
LoadStepSolver::RoundDecision LoadStepSolver::endRound(Rounds& rounds) {
  SolveBounds& bounds = data_.bounds;
  const double left_ms = bounds.leftMs();
  bounds.noteSolve(rounds.of_round);
  const bool is_cut_short =
      data_.motion.isInTimeStep() && rounds.of_round.status == SolveStatus::kLate;
  const bool no_time =
      (bounds.isBounded() && bounds.isTooShort(left_ms)) || is_cut_short || bounds.isTimeStepOver();
  if (rounds.count > 1 && bounds.isLookForNextCall()) {
    data_.outcome.is_late = true;
    worsen(rounds, SolveStatus::kUnconverged);
    return RoundDecision::kDone;
  }
  const RoundShape shape = takeShape(rounds, no_time || bounds.patience().bound().isSpent());
  std::vector<LoadingPatch> of_tools;
  const bool renewed = contact_update_->renew(
      of_tools, shape.whole ? ContactUpdate::Shape::kSolved : ContactUpdate::Shape::kOnItsWay,
      shape.last ? ContactUpdate::Round::kLast : ContactUpdate::Round::kNext);
  if (bounds.isBounded()) bounds.noteLook(left_ms - bounds.leftMs());
  const bool is_settled = !renewed && !shape.is_on_its_way && (shape.last || !shape.hurried);
  if (is_settled) return RoundDecision::kDone;
  if (shape.whole && mayShowUnsettled()) {
    noteUnsettled();
    rounds.report.status = data_.outcome.report.status;
    return RoundDecision::kDone;
  }
  tellWhatIsOpen(rounds, shape, renewed);
  if (shape.last) return RoundDecision::kDone;
  if (renewed) data_.loads.putToolPatches(std::move(of_tools));
  return RoundDecision::kSolveAgain;
}

// Takes the shape that the solve came to, or the share of its way there that contacts allow, as the
// one of the round.
LoadStepSolver::RoundShape LoadStepSolver::takeShape(Rounds& rounds, bool late) {
  const Patience& patience = data_.bounds.patience();
  const SolveReport& report = rounds.report;
  RoundShape shape;
  shape.late = late;
  shape.hurried =
      report.status == SolveStatus::kLate && data_.bounds.wasHurried(rounds.of_round.wall_ms);
  const bool solved = report.status != SolveStatus::kUnconverged && (late || !shape.hurried);
  shape.is_on_its_way = !data_.goesThroughTime() && goBack(rounds);
  shape.whole = !shape.is_on_its_way && solved;
  if (shape.whole) ++rounds.whole;
  rounds.gain.note(rounds.of_round, data_.body.displacement(), shape.whole);
  shape.spent = report.iterations > patience.mostOfLoadStep() || patience.left() == 0;
  const bool stands =
      !solved && !shape.hurried && rounds.count > 1 && data_.body.displacement() == *rounds.before;
  shape.last = late || shape.spent || stands || rounds.gain.isOver() ||
               rounds.whole == tuning::kContactRounds || rounds.count == tuning::kMostRounds;
  return shape;
}

// What time ran out in is told; what is on its way to another place is no shape to show.
void LoadStepSolver::tellWhatIsOpen(Rounds& rounds, const RoundShape& shape, bool renewed) {
  if (shape.late) {
    data_.outcome.is_late = true;
    worsen(rounds, SolveStatus::kLate);
  }
  const bool stays_away = shape.is_on_its_way && !renewed && !shape.late;
  const bool is_none_to_show =
      shape.spent || stays_away || (!shape.whole && data_.bounds.patience().bound().isSpent());
  if (shape.last && is_none_to_show) worsen(rounds, SolveStatus::kUnconverged);
}

void LoadStepSolver::worsen(Rounds& rounds, SolveStatus status) {
  data_.outcome.report.status = rounds.report.status = std::max(rounds.report.status, status);
}

// Of the surface's vertices: a ghost that carries little of one may go farther than it.
void LoadStepSolver::limitWays() {
  std::vector<WayLimit> limits;
  if (contact_update_ != nullptr) {
    const std::vector<double> longest = contact_update_->longestWays();
    for (std::size_t vertex = 0; vertex < longest.size(); ++vertex) {
      if (!std::isfinite(longest[vertex])) continue;
      limits.push_back({data_.body.surface().carriers[vertex], longest[vertex]});
    }
  }
  data_.methods.now().limitWays(std::move(limits));
}

// Takes the shape back to the share of its way that the contacts allow (ContactUpdate::shareOfWay).
// False: all of it is allowed.
bool LoadStepSolver::goBack(const Rounds& rounds) {
  const double share = contact_update_->shareOfWay(*rounds.before);
  if (share >= 1.0) return false;
  data_.outcome.is_as_solved = false;
  takeBack(*rounds.before, share, data_.body.change().displacement);
  takePatchesBack(rounds.driven_before, share, data_.loads.patches());
  data_.deformSurface();
  return true;
}

bool LoadStepSolver::mayShowUnsettled() const {
  const double bearable =
      data_.bounds.patience().bound().bearableDepth() * data_.body.lattice().spacing();
  return bearable > 0.0 && contact_update_->deepestShown() <= bearable;
}

void LoadStepSolver::noteUnsettled() {
  data_.outcome.are_contacts_settled = false;
  data_.outcome.worsen(SolveStatus::kLate);
}

}  // namespace robot_tissue
