// Tissue: cuts, removals, pieces, and the way back.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cutting/blade_surface.h"
#include "cutting/crumbs.h"
#include "cutting/cut.h"
#include "cutting/removal.h"
#include "cutting/split_cells.h"
#include "lattice/connectivity.h"
#include "material/tissue_model.h"
#include "saving/saved_state.h"
#include "solvers/solver_method.h"
#include "tissue/history.h"
#include "tissue/load_ramp.h"
#include "tissue/partings.h"
#include "tissue/tissue_parts.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

// The lattice as an entry of the history has it, with the shape it has now.
LatticeState asBefore(const Lattice& lattice, const History::Entry& entry, SplitCells split,
                      const LatticeState& now) {
  LatticeState state = lattice.restState();
  state.severed.assign(entry.severed.begin(), entry.severed.end());
  state.springs_cut = static_cast<int>(std::count(state.severed.begin(), state.severed.end(), 1));
  takePartings(entry.parted_at, state);
  state.ahead = entry.ahead;
  state.taken = entry.taken;
  if (!state.taken.empty()) noteTaken(lattice, state);
  state.pieces = countPieces(lattice, state);
  if (!isAsMade(state)) state.cells = cellsLeft(lattice, state, split);
  state.displacement = carriedOver(*now.cells, now.displacement, *state.cells);
  return state;
}

// What these patches were told to answer when they were the earlier ones; nothing of new ones.
std::vector<PatchAnswer> asTold(const std::vector<LoadingPatch>& earlier,
                                const std::vector<PatchAnswer>& answers,
                                const std::vector<LoadingPatch>& patches) {
  std::vector<PatchAnswer> told(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (std::size_t j = 0; j < std::min(earlier.size(), answers.size()); ++j) {
      if (earlier[j].name == patches[i].name) told[i] = answers[j];
    }
  }
  return told;
}

}  // namespace

// Balances what other cells and springs leave. Until contacts are renewed, tools' springs are of
// the nodes that there were.
SolveReport TissueParts::changeTopology(const std::vector<int>& disturbed) {
  const double before_ms = bounds_.leftMs();
  body_.change();
  outcome_.is_as_solved = false;
  motion_.noteOtherCells();
  rebuildSurface();
  deformSurface(
      [](const ContactSpring&, const std::vector<Vec3>&) -> Vec3 { return Vec3::Zero(); });
  const std::vector<LoadingPatch> earlier = loads_.patches();
  renewContacts();
  if (motion_.takesNoTime()) return asItIs();
  if (hasTimeForLevels(before_ms)) return solve(disturbed);
  outcome_.report.patches = asTold(earlier, outcome_.report.patches, loads_.patches());
  return leaveToNextCall(disturbed);
}

// before_ms: what was left before the surface was made.
bool TissueParts::hasTimeForLevels(double before_ms) const {
  const double left_ms = bounds_.leftMs();
  if (!bounds_.isBounded() || !std::isfinite(left_ms)) return true;
  return left_ms >= tuning::kLevelsOverSurface * (before_ms - left_ms);
}

// The shape stays, to be balanced by the next solve.
SolveReport TissueParts::leaveToNextCall(const std::vector<int>& disturbed) {
  outcome_.disturb(disturbed);
  outcome_.forgetGhosts(body_.cells());
  outcome_.is_late = true;
  outcome_.worsen(SolveStatus::kLate);
  outcome_.report.iterations = 0;
  outcome_.report.wall_ms = 0.0;
  outcome_.report.volume_ratio = body_.volumeRatio();
  return outcome_.report;
}

CutReport TissueParts::cut(const std::vector<Vec3>& corners) {
  const std::vector<Crossing> crossing = sparingCrumbs(
      body_.lattice(), body_.state(), springsAcross(body_.lattice(), body_.state(), corners));
  CutReport report;
  report.springs_cut = static_cast<int>(crossing.size());
  report.pieces = body_.state().pieces;
  report.solve = outcome_.report;
  if (crossing.empty()) return report;
  const TopologyChange change(*this, History::Kind::kByItself);
  const int torn = springs_torn_;
  const BladeSurface blade = BladeSurface::of(corners, body_.lattice().spacing());
  severAndBalance(crossing, &blade);
  report.solve = tear();
  report.springs_torn = springs_torn_ - torn;
  report.pieces = body_.state().pieces;
  return report;
}

RemoveReport TissueParts::remove(const RemovedSpace& space) {
  const RemoveReport report =
      takeAway(cellsWithin(body_.lattice(), body_.state(), space), Stroke::kBegins);
  if (report.holds_all) {
    throw InputError("the space holds all of the tissue; allowed: one that leaves some of it");
  }
  return report;
}

RemoveReport TissueParts::drill(const CoveredSpace& space, Stroke stroke) {
  const bool reaches = mayReach(space.bounds);
  return takeAway(
      reaches ? cellsWithin(body_.lattice(), body_.state(), space) : std::vector<std::uint8_t>(),
      stroke);
}

RemoveReport TissueParts::takeAway(const std::vector<std::uint8_t>& within, Stroke stroke) {
  RemoveReport report;
  report.pieces = body_.state().pieces;
  report.solve = outcome_.report;
  if (within.empty()) return report;
  const std::vector<std::uint8_t> cells = withCrumbs(body_.lattice(), body_.state(), within);
  const bool leaves_some = std::any_of(
      body_.lattice().cells().begin(), body_.lattice().cells().end(), [&](const Cell& cell) {
        return (takenOf(body_.state(), cell.place) | cells[at(cell.place)]) < 0xff;
      });
  report.holds_all = !leaves_some;
  if (report.holds_all) return report;
  const TopologyChange change(
      *this, stroke == Stroke::kBegins ? History::Kind::kByItself : History::Kind::kStrokeGoesOn);
  removeCells(body_.lattice(), cells, body_.model().splitCells(), body_.change());
  body_.weigh();
  report.volume = volumeOf(body_.lattice(), body_.state(), cells);
  pieces_.renumber();
  report.loads = dropLostLoads();
  dropFreed();
  changeTopology(nodesAround(body_.lattice(), cells, body_.state()));
  report.solve = tear();
  report.pieces = body_.state().pieces;
  return report;
}

// Names of those of which nothing is left.
std::vector<std::string> TissueParts::dropLostLoads() {
  std::vector<std::string> lost = loads_.loseGoneNodes(body_.state(), outcome_.report.patches);
  const auto is_gone = [&](int node) { return isGone(body_.state(), node); };
  std::vector<int>& disturbed = outcome_.disturbed;
  disturbed.erase(std::remove_if(disturbed.begin(), disturbed.end(), is_gone), disturbed.end());
  return lost;
}

int TissueParts::undoable() const { return static_cast<int>(history_.size()); }

SolveReport TissueParts::undo(int count) {
  if (count < 1 || count > undoable()) {
    throw InputError("count: " + std::to_string(count) + " to take back; allowed: " +
                     (undoable() == 0 ? "none, as nothing was cut, removed, torn or sutured"
                                      : "1 to " + std::to_string(undoable())));
  }
  const std::size_t target = history_.size() - static_cast<std::size_t>(count);
  const History::Entry entry = history_.before(target);
  const bool same_loads = history_.hasLoadsSince(target, loads_.namedLoads());
  std::shared_ptr<const SavedState> saved;
  // What is late of the change itself goes with it.
  if (isUntouched() && !loads_.isLoading() && same_loads) saved = entry.state;
  if (saved && saved->in_balance) {
    History kept = history_;
    kept.dropFrom(target);
    const int torn = springs_torn_;
    const SolveReport report = loadState(*saved);
    springs_torn_ = torn;
    history_ = std::move(kept);
    return report;
  }
  motion_.stop();
  body_.change() = asBefore(body_.lattice(), entry, body_.model().splitCells(), body_.state());
  body_.weigh();
  threads_.take(entry.sutures);
  if (threads_.anyWhole()) rebuildSurface();  // nodes may have other numbers than there
  pieces_.take(entry.pieces);
  history_.dropFrom(target);
  if (motion_.takesNoTime()) return changeTopology({});
  threads_.loosen(body_.displacement());
  changeTopology(body_.freeNodes());
  if (threads_.anyWhole()) drawThreadsIn();
  return tear();
}

}  // namespace robot_tissue
