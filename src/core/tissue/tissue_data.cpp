#include "tissue/tissue_data.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "cutting/removal.h"
#include "cutting/split_cells.h"
#include "robot_tissue/core/cells.h"
#include "tissue/front_ties.h"
#include "tissue/tuning.h"

namespace robot_tissue {

TissueData::TissueData(const TissueConfig& tissue, const SolverConfig& solver)
    : body(tissue),
      methods(solver, body),
      motion(tissue, solver, body),
      pieces(body, loads, threads, tissue.free_pieces == FreePieces::kDrop),
      bounds(motion, Patience(methods.now().usualIterations(), body.lattice().nodeCount()),
             solver.max_ms) {}

// Contacts are found anew after each step: what a tool meets on the way must not be far.
double TissueData::stepLength() const {
  return std::min(methods.now().patchStep(), tuning::kToolStep * body.lattice().spacing());
}

bool TissueData::goesThroughTime() const {
  return motion.goesInTime() && methods.now().goesThroughTimeSteps();
}

Tissue::Shape TissueData::shape() const {
  return {body.displacements(),
          body.state().cells,
          loads.patches(),
          loads.named(),
          outcome.report,
          outcome.is_late,
          outcome.are_contacts_settled,
          motion.nodes(),
          motion.isInTime(),
          threads.whole(),
          outcome.is_cut_short,
          outcome.disturbed};
}

void TissueData::restore(const Tissue::Shape& shape) {
  motion.restore(shape.motion, shape.in_time);
  outcome.is_as_solved = false;
  LatticeState& state = body.change();
  state.displacement = carriedOver(*shape.cells, *shape.displacement, *state.cells);
  restRemoved(state);
  loads.restore(shape.patches, shape.named_patches);
  outcome.report = shape.report;
  outcome.is_late = shape.is_late;
  outcome.are_contacts_settled = shape.are_contacts_settled;
  outcome.is_cut_short = shape.is_cut_short;
  outcome.disturbed = shape.disturbed;
  outcome.dropGone(state);
  threads.mend(shape.whole_sutures);
  deformSurface();
}

SavedState TissueData::saved() const {
  SavedState saved;
  saved.lattice = body.state();
  saved.pieces = pieces.numbers()->names();
  saved.loads = loads.namedLoads();
  saved.due = loads.due();
  saved.sutures = threads.all();
  saved.report = outcome.report;
  saved.report.patches.resize(loads.named());  // without the tools
  saved.in_balance = loads.isUntouched() && !isLate() && !motion.isMoving();
  return saved;
}

std::vector<int> TissueData::hangingNodes() const {
  if (body.gravity().isZero(0.0) || motion.goesInTime() || motion.isMoving()) return {};
  return pieces.nodesOfFree();
}

PieceRegistry::Adrift TissueData::adrift() const {
  const bool moves = motion.goesInTime() || motion.isMoving();
  if (moves || !methods.now().findsEquilibrium()) return {};
  return pieces.adrift();
}

SolveReport TissueData::asItIs() {
  motion.wake();
  outcome.report.patches.resize(loads.patches().size());
  return outcome.report;
}

void TissueData::putToolPatches(std::vector<LoadingPatch> of_tools) {
  const std::vector<PatchAnswer> earlier = std::move(outcome.report.patches);
  std::map<std::pair<int, std::string>, std::size_t> number_of;
  for (std::size_t i = loads.named(); i < std::min(loads.patches().size(), earlier.size()); ++i) {
    number_of[{loads.patches()[i].tool.value_or(-1), loads.patches()[i].name}] = i;
  }
  loads.putToolPatches(std::move(of_tools));
  std::vector<PatchAnswer>& now = outcome.report.patches;
  now.assign(earlier.begin(), earlier.begin() + static_cast<std::ptrdiff_t>(
                                                    std::min(earlier.size(), loads.named())));
  now.resize(loads.patches().size());
  for (std::size_t i = loads.named(); i < now.size(); ++i) {
    const auto same =
        number_of.find({loads.patches()[i].tool.value_or(-1), loads.patches()[i].name});
    if (same != number_of.end()) now[i] = earlier[same->second];
  }
}

void TissueData::beginAside() {
  if (methods.isAside()) return;
  bounds.patience().beginTrial();
  methods.switchAside();
}

void TissueData::endAside() {
  if (!methods.isAside()) return;
  bounds.patience().endTrial();
  methods.switchAside();
}

void TissueData::renewTies() {
  threads.tie(tiesOfFronts(body.lattice(), body.state(), body.model()));
}

void TissueData::rebuildSurface() {
  renewTies();
  body.rebuildSurface();
  rebindThreads();
}

void TissueData::rebindThreads() {
  for (const int node : threads.rebind(body.surface(), body.lattice().spacing())) {
    outcome.disturbed.push_back(body.cells().original(node));
  }
}

void TissueData::deformSurface(Body::OffPoint of_tools) { body.deform(loads.patches(), of_tools); }

}  // namespace robot_tissue
