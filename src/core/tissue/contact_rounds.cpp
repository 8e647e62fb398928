// Tissue: solves, each with a look at the contacts of the shape that it came to, until they are
// those that it was solved for.
#include <algorithm>
#include <cmath>
#include <utility>

#include "loads/driven_places.h"
#include "robot_tissue/core/part_of_way.h"
#include "solvers/solver_method.h"
#include "tissue/round_gain.h"
#include "tissue/tissue_parts.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

// The least that another solve would take, of one iteration, about.
double shortestMs(const SolveReport& solve) {
  const double ends = tuning::kIterationsOfEnds;
  return solve.wall_ms * (1.0 + ends) / (std::max(1, solve.iterations) + ends);
}

}  // namespace

struct TissueParts::Rounds {
  explicit Rounds(const Displacements& start) : before(start), gain(start) {}

  Displacements before;                    // the shape that the last round began with
  std::vector<DrivenPlace> driven_before;  // likewise, of patches by a force
  RoundGain gain;
  SolveReport report;    // of all of them
  SolveReport of_round;  // of the last
  int count = 1;
  int whole = 0;  // in which the shape is the one that was solved for
};

SolveReport TissueParts::solveInRounds(const std::vector<int>& disturbed) {
  method_->beginStep(state_);
  if (contact_update_ == nullptr) return solveOnce(disturbed);
  Rounds rounds(displacements());
  rounds.driven_before = drivenPlaces(patches_);
  rounds.report = rounds.of_round = solveOnce(disturbed);
  while (asksForRound(rounds)) {
    rounds.before.reset();  // so that the next line's copy can take its memory
    rounds.before = displacements();
    rounds.driven_before = drivenPlaces(patches_);
    const SolveReport earlier = rounds.report;
    rounds.report = rounds.of_round = solveOnce({});
    rounds.report.wall_ms += earlier.wall_ms;
    rounds.report.iterations += earlier.iterations;
    last_report_ = rounds.report;
    ++rounds.count;
  }
  return rounds.report;
}

// Looks at the contacts. True: they are others, and patches for them are there.
bool TissueParts::asksForRound(Rounds& rounds) {
  SolveReport& report = rounds.report;
  const auto raise = [&](SolveStatus status) {
    last_report_.status = report.status = std::max(report.status, status);
  };
  const double left_ms = isBounded() ? deadline_->leftMs() : 0.0;
  shortest_ms_ = shortestMs(rounds.of_round);
  const bool no_time = isBounded() && left_ms <= 2.0 * look_ms_ + shortest_ms_;
  const bool late = no_time || patience_.bound().isSpent();
  if (rounds.count > 1 && isLookForNextCall()) {
    is_late_ = true;
    raise(SolveStatus::kUnconverged);
    return false;
  }
  const bool hurried = isBounded() && report.status == SolveStatus::kLate;
  const bool solved = report.status != SolveStatus::kUnconverged && (late || !hurried);
  const bool is_on_its_way = !goesThroughTime() && goBack(rounds);
  const bool whole = !is_on_its_way && solved;
  if (whole) ++rounds.whole;
  rounds.gain.note(rounds.of_round, state_.displacement, whole);
  const bool spent = report.iterations > patience_.mostOfLoadStep() || patience_.left() == 0;
  const bool stands =
      !solved && !hurried && rounds.count > 1 && state_.displacement == *rounds.before;
  const bool last = late || spent || stands || rounds.gain.isOver() ||
                    rounds.whole == tuning::kContactRounds || rounds.count == tuning::kMostRounds;
  std::vector<LoadingPatch> of_tools;
  const bool renewed = contact_update_->renew(
      of_tools, whole ? ContactUpdate::Shape::kSolved : ContactUpdate::Shape::kOnItsWay,
      last ? ContactUpdate::Round::kLast : ContactUpdate::Round::kNext);
  if (isBounded()) noteLook(left_ms - deadline_->leftMs());
  if (!renewed && !is_on_its_way && (last || !hurried)) return false;
  if (whole && mayShowUnsettled()) {
    noteUnsettled();
    report.status = last_report_.status;
    return false;
  }
  if (late) {
    is_late_ = true;
    raise(SolveStatus::kLate);
  }
  // What time ran out in is told; what is on its way to another place is no shape to show.
  const bool stays_away = is_on_its_way && !renewed && !late;
  const bool is_none_to_show = spent || stays_away || (!whole && patience_.bound().isSpent());
  if (last && is_none_to_show) raise(SolveStatus::kUnconverged);
  if (!last && renewed) putToolPatches(std::move(of_tools));
  return !last;
}

// Of the surface's vertices: a ghost that carries little of one may go farther than it.
void TissueParts::limitWays() {
  std::vector<WayLimit> limits;
  if (contact_update_ != nullptr) {
    const std::vector<double> longest = contact_update_->longestWays();
    for (std::size_t vertex = 0; vertex < longest.size(); ++vertex) {
      if (!std::isfinite(longest[vertex])) continue;
      limits.push_back({surface_.carriers[vertex], longest[vertex]});
    }
  }
  method_->limitWays(std::move(limits));
}

// Takes the shape back to the share of its way that the contacts allow (ContactUpdate::shareOfWay).
// False: all of it is allowed.
bool TissueParts::goBack(const Rounds& rounds) {
  const double share = contact_update_->shareOfWay(*rounds.before);
  if (share >= 1.0) return false;
  kept_.reset();
  is_as_solved_ = false;
  takeBack(*rounds.before, share, state_.displacement);
  takePatchesBack(rounds.driven_before, share, patches_);
  deformSurface();
  return true;
}

}  // namespace robot_tissue
