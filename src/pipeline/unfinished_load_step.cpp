// LoadStepper: load steps that have no time or iterations left, and how they are gone on with.
#include <algorithm>
#include <cmath>
#include <utility>

#include "load_stepper.h"
#include "tuning.h"

namespace robot_tissue {

bool LoadStepper::takesShapeOrLeaves(const RobotPose& pose, IfUnconverged otherwise) {
  const LoadStepBound::Scope bound(world_.tissue.patience().bound(), world_.mostIterations());
  Checkpoint good = toolsCheckpoint();  // its shape where there is something to solve
  world_.pose = pose;
  grasping_.openJaws();
  world_.sliding.ride(pose, world_.tissue);  // patches move with their tools
  if (takesShape(pose, good, otherwise)) return true;
  leave(good, otherwise, 0);
  return false;
}

// All is as it was before the load step. What it came to is kept where more time may help: a slip
// takes many updates' time, and begun anew it would never be through.
void LoadStepper::leave(const Checkpoint& good, IfUnconverged otherwise, int iterations) {
  state_.ran_out_of_time = std::exchange(waits_for_call_, false) || isOutOfTime();
  iterations += std::max(1, world_.tissue.lastReport().iterations);
  const bool is_late = state_.ran_out_of_time && iterations <= tuning::kMostUnderWay;
  std::optional<Checkpoint> came_to;
  if (is_late && !world_.tools.anyRigid() && !world_.is_trial) came_to = checkpoint();
  goBackTo(good);
  if (!came_to) return;
  state_.under_way =
      UnfinishedLoadStep{std::move(*came_to), otherwise, iterations, world_.tissue.displacements(),
                         world_.tissue.surface().revision};
}

// Unless something else moved or cut the tissue since.
bool LoadStepper::isUnderWay() const {
  return state_.under_way && state_.under_way->from == world_.tissue.displacements() &&
         state_.under_way->surface_revision == world_.tissue.surface().revision;
}

void LoadStepper::keepUnderWay() {
  if (state_.under_way) state_.under_way->from = world_.tissue.displacements();
}

bool LoadStepper::goOn() {
  ++world_.report.substeps;
  if (!goesOnOrLeaves()) return false;
  arrive();
  return true;
}

bool LoadStepper::goesOnOrLeaves() {
  const LoadStepBound::Scope bound(world_.tissue.patience().bound(), world_.mostIterations());
  const Checkpoint good = checkpoint();
  const UnfinishedLoadStep step = std::move(*state_.under_way);
  state_.under_way.reset();
  goBackTo(step.came_to);
  Patience& patience = world_.tissue.patience();
  const Patience::LoadStep load_step(patience);
  solveOn();
  if (settlesFrom(good, step.otherwise)) return true;
  patience.noteLost();
  leave(good, step.otherwise, step.iterations);
  if (!state_.under_way && step.otherwise == IfUnconverged::kTake) {
    world_.report.lost = true;
    world_.dead_end = DeadEnd{good.pose, step.came_to.pose};
  }
  return false;
}

void LoadStepper::solveOn() {
  std::vector<LoadingPatch> patches = patchesOfTools(world_);
  if (patches.empty()) patches = touchesAtRest(world_.pose);
  follow(std::move(patches));
}

// Finding the contacts, as of a mesh, may take so much of a call's time that solving for them would
// end after it: they are solved for first of all in the next one.
bool LoadStepper::leavesToNextCall() {
  waits_for_call_ = !world_.tools.anyRigid() && !world_.is_trial && !world_.tissue.isInTimeStep() &&
                    world_.tissue.isRoundForNextCall();
  return waits_for_call_;
}

// Or out of iterations. Also where there was none for another solve.
bool LoadStepper::isOutOfTime() const {
  if (world_.tissue.patience().bound().isSpent()) return true;
  const bool is_bounded = std::isfinite(world_.deadline.leftMs());
  return is_bounded && (world_.deadline.isOver() || world_.tissue.isLate());
}

}  // namespace robot_tissue
