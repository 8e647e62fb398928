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

// What lies flat is in balance soon; what does not, or is thrown away by the solve, is followed on
// its way.
SolveReport Pipeline::settleLoose() {
  LoadStepper& load_step = parts_->load_step;
  const Checkpoint before = load_step.checkpoint();
  {
    const LoadStepBound::Scope bound(world_.tissue.patience().bound(), tuning::kIterationsOfLying);
    const SolveReport report = balance();
    const bool is_lying = report.status == SolveStatus::kOk && !world_.tissue.anyHangs();
    if (is_lying && !wentFartherFrom(*before.shape.displacement, tuning::kMostLeap)) return report;
  }
  const bool any_tool = anyToolIn(world_.tissue.patches(), world_);
  if (!any_tool) return land(before.shape);
  load_step.goBackTo(before);
  balance();
  if (wentFartherFrom(*before.shape.displacement, tuning::kMostLeap)) {
    world_.tissue.noteUnconverged();
  }
  return world_.tissue.lastReport();
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

// From where it was. What does not come to lie stays there; what hangs over nothing is in balance.
SolveReport Pipeline::land(const Tissue::Shape& before) {
  const bool any_hangs = world_.tissue.anyHangs();
  putInPlace(before.displacement, before.cells);
  const std::shared_ptr<const CellSet> cells = world_.tissue.state().cells;
  const auto lies = [&](const Tissue::Displacements& there, Landing::Look look) {
    const bool is_on_its_way = look == Landing::Look::kOnItsWay;
    const LoadStepBound::Scope bound(world_.tissue.patience().bound(),
                                     is_on_its_way ? tuning::kIterationsOfLying : 0);
    putInPlace(there, cells);
    return liesNear(*there, look == Landing::Look::kAtRest);
  };
  const Landing::End end = landing_->from(world_.tissue, end_.value_or(Deadline()), lies);
  if (end == Landing::End::kLies) return world_.tissue.lastReport();
  putInPlace(before.displacement, before.cells);
  if (end == Landing::End::kNothingBelow && any_hangs) return balance();
  world_.tissue.noteUnconverged();
  return world_.tissue.lastReport();
}

// Whether the tissue, which is there, is in balance near to it. What rests there lies in any case,
// but a solve that throws it away is no answer.
bool Pipeline::liesNear(const std::vector<Vec3>& there, bool rests) {
  const SolveStatus status = balance().status;
  const bool is_lying = status == SolveStatus::kOk && !world_.tissue.anyHangs();
  return (rests || is_lying) && !wentFartherFrom(there, tuning::kMostToLie);
}

// Whether a node is farther from there than so many spacings.
bool Pipeline::wentFartherFrom(const std::vector<Vec3>& there, double spacings) const {
  const std::vector<Vec3>& now = world_.tissue.state().displacement;
  const std::vector<int>& piece_of = world_.tissue.pieceOfNodes();
  const double most = spacings * world_.tissue.lattice().spacing();
  for (std::size_t node = 0; node < std::min(now.size(), there.size()); ++node) {
    if (piece_of[node] >= 0 && (now[node] - there[node]).squaredNorm() > most * most) return true;
  }
  return false;
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
