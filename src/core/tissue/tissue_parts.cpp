#include "tissue/tissue_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/removal.h"
#include "cutting/split_cells.h"
#include "cutting/tear.h"
#include "lattice/piece_numbers.h"
#include "membrane/membrane_plan.h"
#include "robot_tissue/core/body_load.h"
#include "robot_tissue/core/cells.h"
#include "surface/mesh_surface.h"
#include "tissue/history.h"
#include "tissue/load_ramp.h"
#include "tissue/registry.h"
#include "tissue/threads.h"
#include "tissue/time_integrator.h"
#include "tissue/tissue_state.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

bool isFinite(const Vec3& vector) { return vector.allFinite(); }

bool hasOnlyFiniteNumbers(const SolveReport& report) {
  return std::isfinite(report.residual) && std::isfinite(report.error_estimate) &&
         std::all_of(report.patches.begin(), report.patches.end(), [](const PatchAnswer& patch) {
           return isFinite(patch.force) && isFinite(patch.torque) && isFinite(patch.displacement);
         });
}

}  // namespace

TissueParts::TissueParts(const TissueConfig& tissue, const SolverConfig& solver)
    : body_(tissue),
      tear_strains_(tearStrains(body_.lattice(), tissue)),
      methods_(solver, body_),
      motion_(tissue, solver, body_),
      pieces_(body_, loads_, threads_, tissue.free_pieces == FreePieces::kDrop),
      bounds_(motion_, Patience(methods_.now().usualIterations(), body_.lattice().nodeCount()),
              solver.max_ms),
      balance_fingerprint_(balanceFingerprint(tissue, solver)) {}

TissueParts::~TissueParts() = default;

// Contacts are found anew after each step: what a tool meets on the way must not be far.
double TissueParts::stepLength() const {
  return std::min(methods_.now().patchStep(), tuning::kToolStep * body_.lattice().spacing());
}

SolveReport TissueParts::settle() {
  motion_.stop();
  solve(body_.freeNodes());
  return tear();
}

SolveReport TissueParts::follow(std::vector<LoadingPatch> tool_patches,
                                const std::vector<int>& disturbed, Bedding bedding) {
  const bool one_left = loads_.isOneLeftBy(tool_patches);
  loads_.putToolPatches(std::move(tool_patches));
  const bool last_left = one_left && isUntouched();
  const bool returns = methods_.now().findsEquilibrium() && bedding == Bedding::kFixedNodes;
  if (motion_.isInTime()) return motion_.isInTimeStep() ? solve(disturbed) : asItIs();
  const bool from_rest = methods_.now().findsEquilibrium() ? last_left && returns : one_left;
  if (from_rest) return solveFromRest();
  const bool one_there = !isUntouched();
  const SolveReport report = solve(disturbed);
  // The tissue left the last tool behind in the solve.
  const bool one_lost = one_there && isUntouched();
  return one_lost && returns ? solveFromRest() : report;
}

TissueParts::Shape TissueParts::shape() const {
  return {body_.displacements(),
          body_.state().cells,
          loads_.patches(),
          loads_.named(),
          outcome_.report,
          outcome_.is_late,
          outcome_.are_contacts_settled,
          motion_.nodes(),
          motion_.isInTime(),
          threads_.whole()};
}

void TissueParts::restore(const Shape& shape) {
  motion_.restore(shape.motion, shape.in_time);
  outcome_.is_as_solved = false;
  LatticeState& state = body_.change();
  state.displacement = carriedOver(*shape.cells, *shape.displacement, *state.cells);
  restRemoved(state);
  loads_.restore(shape.patches, shape.named_patches);
  outcome_.report = shape.report;
  outcome_.is_late = shape.is_late;
  outcome_.are_contacts_settled = shape.are_contacts_settled;
  threads_.mend(shape.whole_sutures);
  deformSurface();
}

void TissueParts::beginAside() {
  if (methods_.isAside()) return;
  bounds_.patience().beginTrial();
  methods_.switchAside();
}

void TissueParts::endAside() {
  if (!methods_.isAside()) return;
  bounds_.patience().endTrial();
  methods_.switchAside();
}

void TissueParts::reset() {
  const bool was_cut = !isAsMade(body_.state());
  motion_.stop();
  endAside();
  bounds_.patience().forget();
  methods_.forget();
  body_.change() = body_.lattice().restState();
  threads_.clear();
  loads_.take({});
  outcome_ = SolveOutcome();
  springs_torn_ = 0;
  history_.clear();
  if (was_cut) {
    body_.weigh();
    rebuildSurface();
  }
  pieces_.take(std::make_shared<const PieceNumbers>(body_.lattice(), body_.state()));
  body_.showRest();
  motion_.wakeUnderBodyLoad();
}

void TissueParts::expectTouch() {
  if (!motion_.hasTime()) methods_.now().expect(body_.state());
}

// The surface is another one: touches are found anew where it is now.
void TissueParts::renewContacts() {
  if (contact_update_ == nullptr) return;
  std::vector<LoadingPatch> of_tools;
  contact_update_->renew(of_tools, ContactUpdate::Shape::kSolved, ContactUpdate::Round::kNext);
  loads_.putToolPatches(
      std::move(of_tools));  // none, too: those of before may be on ghosts that are gone
}

SolveReport TissueParts::solve(const std::vector<int>& disturbed) {
  const Patience::LoadStep load_step(bounds_.patience());
  outcome_.disturb(disturbed);
  SolveReport report = solveAndBreak(outcome_.disturbed);
  if (motion_.isInTimeStep())
    outcome_.is_late = false;  // what it left, the next time step takes up
  if (!outcome_.is_late) outcome_.disturbed.clear();
  outcome_.forgetGhosts(body_.cells());
  outcome_.report.volume_ratio = report.volume_ratio = body_.volumeRatio();
  return report;
}

SolveReport TissueParts::solveOnce(const std::vector<int>& disturbed) {
  // Where contacts are looked at, the shape is kept in any case; else a copy would cost more than
  // it saves a method that stays finite.
  const bool keeps_shape = contact_update_ != nullptr || !methods_.now().staysFinite();
  const Displacements last_good = keeps_shape ? body_.displacements() : nullptr;
  std::vector<LoadingPatch>& patches = loads_.patches();
  const std::vector<LoadingPatch> last_good_patches = patches;
  LatticeState& state = body_.change();
  limitWays();
  const double cost = costOfIteration();
  methods_.now().limitTime(bounds_.mostMs());
  methods_.now().limitIterations(bounds_.mostIterations(cost));
  const bool any_hangs = holdHanging();
  SolveReport report = solveWithThreads(disturbed, state);
  if (any_hangs) letHangingBe(report);
  const bool is_finite =
      hasOnlyFiniteNumbers(report) &&
      (methods_.now().staysFinite() ||
       std::all_of(state.displacement.begin(), state.displacement.end(), isFinite));
  if (!is_finite) {
    if (last_good) state.displacement = *last_good;
    patches = last_good_patches;
    report = SolveReport();
    report.status = SolveStatus::kUnconverged;
    report.patches.resize(patches.size());
  }
  outcome_.is_late = report.status == SolveStatus::kLate;
  outcome_.is_as_solved = is_finite;
  outcome_.are_contacts_settled = true;
  const bool converged = report.status != SolveStatus::kUnconverged;
  // Loads alone are an answer, however long it took.
  if (converged && isUntouched()) {
    bounds_.patience().noteEasy();
  } else {
    bounds_.patience().note(report.iterations, converged, bounds_.solved(), cost);
  }
  describeShape(report);
  outcome_.report = report;
  return report;
}

// Without a load the rest shape is the equilibrium that every path ends in. The six-spring lattice
// holds sheared shapes without a force, so relaxing back from a deformed shape would not find it.
SolveReport TissueParts::solveFromRest() {
  const std::vector<LoadingPatch> standing = loads_.patches();
  methods_.now().forget();
  std::vector<Vec3>& displacement = body_.change().displacement;
  std::fill(displacement.begin(), displacement.end(), Vec3::Zero());
  SolveReport report;
  const bool sutured = threads_.anyWhole();
  if (body_.hasBodyLoad() || sutured) {
    const std::size_t named = loads_.named();
    loads_.restore({}, 0);
    report = settleFromRest();
    loads_.putBack(standing, named);
  }
  std::vector<LoadRamp> ramps;
  for (std::size_t patch = 0; patch < standing.size(); ++patch) {
    ramps.push_back(makeRamp(standing[patch], nullptr));
    ramps.back().patch = patch;
    ramps.back().start.force.setZero();
    loads_.patches()[patch] = ramps.back().start;
  }
  if (!ramps.empty()) {
    report = stepLoadsByItself(ramps, {});
  } else if (!body_.hasBodyLoad() && !sutured) {
    describeShape(report);
    report.volume_ratio = body_.volumeRatio();
    outcome_.report = report;
    outcome_.is_late = false;
  }
  return report;
}

void TissueParts::deformSurface(Body::OffPoint of_tools) {
  body_.deform(loads_.patches(), of_tools);
}

// On other cells: what threads and ties hang on is found there.
void TissueParts::rebuildSurface() {
  renewTies();
  body_.rebuildSurface();
  rebindThreads();
}

void TissueParts::describeShape(SolveReport& report) {
  deformSurface();
  const GridBox* visited = methods_.now().visited();
  report.inverted_cells = visited == nullptr
                              ? countInvertedCells(body_.lattice(), body_.state())
                              : countInvertedCells(body_.lattice(), body_.state(), *visited);
  if (report.inverted_cells > 0) report.status = SolveStatus::kInverted;
}

}  // namespace robot_tissue
