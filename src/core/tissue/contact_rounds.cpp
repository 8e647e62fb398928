// Tissue: solves, each with a look at the contacts of the shape that it came to, until they are
// those that it was solved for.
#include <algorithm>
#include <cmath>
#include <utility>

#include "loads/driven_places.h"
#include "robot_tissue/core/part_of_way.h"
#include "solvers/solver_method.h"
#include "tissue/round_gain.h"
#include "tissue/solve_total.h"
#include "tissue/tissue_parts.h"
#include "tissue/tuning.h"

namespace robot_tissue {
struct TissueParts::Rounds {
  explicit Rounds(const Displacements& start) : before(start), gain(start) {}

  Displacements before;                    // the shape that the last round began with
  std::vector<DrivenPlace> driven_before;  // of patches by a force, where the last round began
  RoundGain gain;
  SolveReport report;    // of all of them
  SolveReport of_round;  // of the last
  int count = 1;
  int whole = 0;  // in which the shape is the one that was solved for
};

struct TissueParts::RoundShape {
  bool late = false;           // no time, or no iterations, are left for another solve
  bool hurried = false;        // the solve was cut short by the clock
  bool is_on_its_way = false;  // contacts allow a share of the solve's way alone
  bool whole = false;          // the shape is the one that was solved for, in balance
  bool spent = false;          // there is no patience for another solve
  bool last = false;           // no further solve follows, whatever the contacts are
};

SolveReport TissueParts::solveInRounds(const std::vector<int>& disturbed) {
  methods_.now().beginStep(body_.state());
  if (contact_update_ == nullptr) return solveOnce(disturbed);
  Rounds rounds(body_.displacements());
  rounds.driven_before = drivenPlaces(loads_.patches());
  rounds.report = rounds.of_round = solveOnce(disturbed);
  while (endRound(rounds) == RoundDecision::kSolveAgain) {
    rounds.before.reset();  // so that the next line's copy can take its memory
    rounds.before = body_.displacements();
    rounds.driven_before = drivenPlaces(loads_.patches());
    SolveTotal total(rounds.report);
    rounds.report = rounds.of_round = solveOnce({});
    total.addWork(rounds.report);
    total.tellWorkIn(rounds.report);
    outcome_.report = rounds.report;
    ++rounds.count;
  }
  return rounds.report;
}

// The look at the contacts after a solve: the shape is taken back to where contacts allow it, the
// contacts are renewed, and the report tells what is left open. Where it is to be solved again, the
// patches are those for it.
TissueParts::RoundDecision TissueParts::endRound(Rounds& rounds) {
  const double left_ms = bounds_.leftMs();
  bounds_.noteSolve(rounds.of_round);
  const bool no_time = bounds_.isBounded() && bounds_.isTooShort(left_ms);
  if (rounds.count > 1 && bounds_.isLookForNextCall()) {
    outcome_.is_late = true;
    worsen(rounds, SolveStatus::kUnconverged);
    return RoundDecision::kDone;
  }
  const RoundShape shape = takeShape(rounds, no_time || bounds_.patience().bound().isSpent());
  std::vector<LoadingPatch> of_tools;
  const bool renewed = contact_update_->renew(
      of_tools, shape.whole ? ContactUpdate::Shape::kSolved : ContactUpdate::Shape::kOnItsWay,
      shape.last ? ContactUpdate::Round::kLast : ContactUpdate::Round::kNext);
  if (bounds_.isBounded()) bounds_.noteLook(left_ms - bounds_.leftMs());
  const bool is_settled = !renewed && !shape.is_on_its_way && (shape.last || !shape.hurried);
  if (is_settled) return RoundDecision::kDone;
  if (shape.whole && mayShowUnsettled()) {
    noteUnsettled();
    rounds.report.status = outcome_.report.status;
    return RoundDecision::kDone;
  }
  tellWhatIsOpen(rounds, shape, renewed);
  if (shape.last) return RoundDecision::kDone;
  if (renewed) loads_.putToolPatches(std::move(of_tools));
  return RoundDecision::kSolveAgain;
}

// Takes the shape that the solve came to, or the share of its way there that contacts allow, as the
// one of the round.
TissueParts::RoundShape TissueParts::takeShape(Rounds& rounds, bool late) {
  const SolveReport& report = rounds.report;
  RoundShape shape;
  shape.late = late;
  shape.hurried = bounds_.isBounded() && report.status == SolveStatus::kLate;
  const bool solved = report.status != SolveStatus::kUnconverged && (late || !shape.hurried);
  shape.is_on_its_way = !goesThroughTime() && goBack(rounds);
  shape.whole = !shape.is_on_its_way && solved;
  if (shape.whole) ++rounds.whole;
  rounds.gain.note(rounds.of_round, body_.displacement(), shape.whole);
  shape.spent =
      report.iterations > bounds_.patience().mostOfLoadStep() || bounds_.patience().left() == 0;
  const bool stands =
      !solved && !shape.hurried && rounds.count > 1 && body_.displacement() == *rounds.before;
  shape.last = late || shape.spent || stands || rounds.gain.isOver() ||
               rounds.whole == tuning::kContactRounds || rounds.count == tuning::kMostRounds;
  return shape;
}

// What time ran out in is told; what is on its way to another place is no shape to show.
void TissueParts::tellWhatIsOpen(Rounds& rounds, const RoundShape& shape, bool renewed) {
  if (shape.late) {
    outcome_.is_late = true;
    worsen(rounds, SolveStatus::kLate);
  }
  const bool stays_away = shape.is_on_its_way && !renewed && !shape.late;
  const bool is_none_to_show =
      shape.spent || stays_away || (!shape.whole && bounds_.patience().bound().isSpent());
  if (shape.last && is_none_to_show) worsen(rounds, SolveStatus::kUnconverged);
}

void TissueParts::worsen(Rounds& rounds, SolveStatus status) {
  outcome_.report.status = rounds.report.status = std::max(rounds.report.status, status);
}

// Of the surface's vertices: a ghost that carries little of one may go farther than it.
void TissueParts::limitWays() {
  std::vector<WayLimit> limits;
  if (contact_update_ != nullptr) {
    const std::vector<double> longest = contact_update_->longestWays();
    for (std::size_t vertex = 0; vertex < longest.size(); ++vertex) {
      if (!std::isfinite(longest[vertex])) continue;
      limits.push_back({body_.surface().carriers[vertex], longest[vertex]});
    }
  }
  methods_.now().limitWays(std::move(limits));
}

// Takes the shape back to the share of its way that the contacts allow (ContactUpdate::shareOfWay).
// False: all of it is allowed.
bool TissueParts::goBack(const Rounds& rounds) {
  const double share = contact_update_->shareOfWay(*rounds.before);
  if (share >= 1.0) return false;
  outcome_.is_as_solved = false;
  takeBack(*rounds.before, share, body_.change().displacement);
  takePatchesBack(rounds.driven_before, share, loads_.patches());
  deformSurface();
  return true;
}

bool TissueParts::mayShowUnsettled() const {
  const double bearable = bounds_.patience().bound().bearableDepth() * body_.lattice().spacing();
  return bearable > 0.0 && contact_update_->deepestShown() <= bearable;
}

void TissueParts::noteUnsettled() {
  outcome_.are_contacts_settled = false;
  outcome_.worsen(SolveStatus::kLate);
}

// Over that of an iteration with few touches, on a lattice that is whole. Where there are more
// touches than nodes, as of a fine mesh on a coarse lattice, they are most of the work; so are
// cells that cuts parted.
double TissueParts::costOfIteration() const {
  double touches = 0.0;
  for (const LoadingPatch& patch : loads_.patches())
    touches += static_cast<double>(patch.contacts.size());
  const double nodes = body_.lattice().nodeCount();
  const double ghosts = static_cast<double>(body_.displacement().size()) - nodes;
  return std::max({1.0, touches / (nodes + ghosts),
                   (nodes + tuning::kNodesOfGhost * ghosts) / std::max(nodes, tuning::kFewNodes)});
}

}  // namespace robot_tissue
