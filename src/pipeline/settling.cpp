// Pipeline: balance where the tools stand, and how what nothing holds comes to lie.
#include <algorithm>
#include <utility>

#include "landing.h"
#include "pipeline_parts.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {

bool Pipeline::isLoose() const {
  if (!landing_) return false;
  const std::vector<TissuePiece> pieces = world_.tissue.restingPieces();
  return std::any_of(pieces.begin(), pieces.end(),
                     [](const TissuePiece& piece) { return !piece.fixed; });
}

SolveReport Pipeline::settle() {
  world_.tissue.stopTime();
  const bool any_loose = isLoose();
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
  const Checkpoint before = load_step.checkpoint();
  {
    const LoadStepBound::Scope bound(world_.tissue.patience().bound(), tuning::kIterationsOfLying);
    const SolveReport report = balance();
    if (report.status == SolveStatus::kOk && !world_.tissue.anyHangs()) return report;
  }
  const bool any_tool = anyToolIn(world_.tissue.patches(), world_);
  if (!any_tool) return land(before.shape);
  load_step.goBackTo(before);
  return balance();
}

std::optional<Tissue::Shape> Pipeline::shapeOfLoose() const {
  return isLoose() ? std::optional<Tissue::Shape>(world_.tissue.shape()) : std::nullopt;
}

// After a change that the report is of. What it parted may topple.
SolveReport Pipeline::comeToLie(const std::optional<Tissue::Shape>& before,
                                const SolveReport& report) {
  const bool falls = before && report.status == SolveStatus::kUnconverged;
  return falls && !anyToolIn(world_.tissue.patches(), world_) ? land(*before) : report;
}

// From where it was. What does not come to lie stays there; what hangs is in balance so.
SolveReport Pipeline::land(const Tissue::Shape& before) {
  const bool any_hangs = world_.tissue.anyHangs();
  putInPlace(before.displacement, before.cells);
  const Tissue::Displacements lain = landing_->from(world_.tissue, end_.value_or(Deadline()));
  if (lain != nullptr) {
    putInPlace(lain, world_.tissue.state().cells);
  } else if (!any_hangs) {
    world_.tissue.noteUnconverged();
    return world_.tissue.lastReport();
  }
  return balance();
}

// Displacements (m) of these cells' nodes; supports are met anew.
void Pipeline::putInPlace(Tissue::Displacements displacement,
                          std::shared_ptr<const CellSet> cells) {
  Tissue::Shape shape = world_.tissue.shape();
  shape.displacement = std::move(displacement);
  shape.cells = std::move(cells);
  world_.tissue.restore(shape);
  world_.sliding.clear();
  world_.sliding.commit(world_.pose, world_.tissue);
}

}  // namespace robot_tissue
