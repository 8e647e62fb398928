// Tissue: how long a solve may take.
#include <algorithm>
#include <cmath>

#include "tissue/tissue_parts.h"
#include "tissue/tuning.h"

namespace robot_tissue {

// Half a time step is no shape that tissue moves through, and what a solve leaves would, over the
// square of the step, be accelerations: no clock cuts it short.
bool TissueParts::isBounded() const { return deadline_ && !in_time_step_; }

// Time for the next solve (ms); 0: no bound.
double TissueParts::mostMs() const {
  if (in_time_step_) return 0.0;
  if (!deadline_) return max_ms_;
  const double left = deadline_->leftMs();
  if (!std::isfinite(left)) return max_ms_;
  const double solve = std::min(tuning::kShareOfTime * left, left - look_ms_);
  const double most = std::max(tuning::kLeastMs, solve);
  return max_ms_ > 0.0 ? std::min(max_ms_, most) : most;
}

// How long a look at the contacts took.
void TissueParts::noteLook(double ms) { look_ms_ = std::max(ms, tuning::kLooksFade * look_ms_); }

bool TissueParts::isRoundForNextCall() const {
  if (!isBounded()) return false;
  const double round = shortest_ms_ + look_ms_;
  return deadline_->leftMs() < round && round <= deadline_->wholeMs();
}

// As of a mesh, after a solve that took longer than it was to. What it came to is no shape to show.
bool TissueParts::isLookForNextCall() const {
  return isRoundForNextCall() && deadline_->leftMs() < look_ms_ - tuning::kMostOverstepMs;
}

// Of the next solve.
int TissueParts::mostIterations() const {
  const int left = patience_.left(solved(), costOfIteration());
  return std::max(1, in_time_step_ ? left : std::min(left, patience_.bound().left()));
}

bool TissueParts::mayShowUnsettled() const {
  const double bearable = patience_.bound().bearableDepth() * body_.lattice().spacing();
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

Patience::Of TissueParts::solved() const {
  return in_time_step_ ? Patience::Of::kTimeStep : Patience::Of::kLoadStep;
}

}  // namespace robot_tissue
