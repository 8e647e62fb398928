// Pipeline: balance where the tools stand, and how what nothing holds comes to lie.
#include <algorithm>

#include "landing.h"
#include "pipeline_parts.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {

SolveReport Pipeline::settle() {
  world_.tissue.stopTime();
  const std::vector<TissuePiece> pieces =
      landing_ ? world_.tissue.restingPieces() : std::vector<TissuePiece>();
  const bool any_loose = std::any_of(pieces.begin(), pieces.end(),
                                     [](const TissuePiece& piece) { return !piece.fixed; });
  SolveReport report;
  double whole_ms = 0.0;  // the way to where it lies included
  {
    const Stopwatch watch(whole_ms);
    report = any_loose ? settleLoose() : balance();
  }
  if (any_loose) report.wall_ms = whole_ms;
  touch();
  return report;
}

SolveReport Pipeline::balance() {
  const Bounded bounded(*this);
  return parts_->load_step.balance();
}

// What lies flat is in balance soon; what does not is followed on its way.
SolveReport Pipeline::settleLoose() {
  LoadStepper& load_step = parts_->load_step;
  Checkpoint before = load_step.checkpoint();
  {
    const LoadStepBound::Scope bound(world_.tissue.patience().bound(), tuning::kIterationsOfLying);
    const SolveReport report = balance();
    if (report.status == SolveStatus::kOk && !world_.tissue.anyHangs()) return report;
  }
  const bool any_hangs = world_.tissue.anyHangs();
  const bool any_tool = anyToolIn(world_.tissue.patches(), world_);
  load_step.goBackTo(before);
  if (any_tool) return balance();
  const Tissue::Displacements lain = landing_->from(world_.tissue, end_);
  if (lain == nullptr && !any_hangs) {
    world_.tissue.noteUnconverged();
    return world_.tissue.lastReport();
  }
  if (lain != nullptr) {
    before.shape.displacement = lain;
    load_step.goBackTo(before);
    world_.sliding.commit(world_.pose, world_.tissue);
  }
  return balance();
}

}  // namespace robot_tissue
