#include "load_stepper.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "rim_link.h"
#include "stopwatch.h"
#include "tearing.h"
#include "tuning.h"
#include "way_lengths.h"

namespace robot_tissue {

LoadStepEnd LoadStepper::advance(const RobotPose& pose, IfUnconverged otherwise) {
  under_way_.forget();
  world_.unfinished = false;
  ++world_.report.substeps;
  const LoadStepEnd end = goTo(pose, otherwise);
  if (end == LoadStepEnd::kArrived) arrive();
  return end;
}

LoadStepEnd LoadStepper::finish(const RobotPose& pose) {
  if (!isUnderWay()) return advance(pose);
  ++world_.report.substeps;
  const LoadStepEnd end = goOn();
  if (end == LoadStepEnd::kArrived) arrive();
  return end;
}

LoadStepEnd LoadStepper::goTo(const RobotPose& pose, IfUnconverged otherwise) {
  Patience& patience = world_.tissue.patience();
  const LoadStepBound::Scope bound(patience.bound(), world_.mostIterations());
  Checkpoint good = toolsCheckpoint();  // its shape where there is something to solve
  world_.pose = pose;
  grasping_.openJaws();
  world_.sliding.ride(pose, world_.tissue);  // patches move with their tools
  Solved solved = Solved::kFollows;
  {
    const Patience::LoadStep load_step(patience);
    solved = followTools(pose, good, otherwise);
    if (solved == Solved::kLost) patience.noteLost();
  }
  if (solved != Solved::kFollows) return leave(good, otherwise, solved, 0);
  if (!endsTooLong()) return LoadStepEnd::kArrived;
  goBackTo(good);
  return LoadStepEnd::kTooLong;
}

LoadStepEnd LoadStepper::goOn() {
  Patience& patience = world_.tissue.patience();
  const LoadStepBound::Scope bound(patience.bound(), world_.mostIterations());
  const Checkpoint good = checkpoint();
  const UnfinishedLoadStep::Rest step = under_way_.take();
  goBackTo(step.came_to);
  const Patience::LoadStep load_step(patience);
  solveOn();
  const Solved solved = settle(good, step.otherwise);
  if (solved == Solved::kFollows) return LoadStepEnd::kArrived;
  patience.noteLost();
  const LoadStepEnd end = leave(good, step.otherwise, solved, step.iterations);
  if (end != LoadStepEnd::kUnderWay && step.otherwise == IfUnconverged::kTake) {
    world_.report.lost = true;
    world_.dead_end = DeadEnd{good.pose, step.came_to.pose};
  }
  return end;
}

void LoadStepper::arrive() {
  world_.tissue.endTimeStep();
  world_.reached_s = world_.pose.stamp_s;
  grasping_.closeJaws();
  world_.sliding.commit(world_.pose, world_.tissue);
  grasping_.endOverpulled();
  tearStretched(world_);
  world_.dead_end.reset();
}

// All is as it was before the load step. What it came to is kept where more time may help.
LoadStepEnd LoadStepper::leave(const Checkpoint& good, IfUnconverged otherwise, Solved solved,
                               int iterations_before) {
  const bool ran_out_of_time = solved == Solved::kLeftToNextCall || world_.isOutOfTime();
  const int iterations = iterations_before + std::max(1, world_.tissue.lastReport().iterations);
  const bool is_kept = ran_out_of_time && iterations <= tuning::kMostUnderWay &&
                       !world_.tools.anyRigid() && !world_.is_trial &&
                       !world_.tissue.isInTimeStep();
  std::optional<Checkpoint> came_to;
  if (is_kept) came_to = checkpoint();
  goBackTo(good);
  if (!came_to) return ran_out_of_time ? LoadStepEnd::kOutOfTime : LoadStepEnd::kNoShape;
  under_way_.keep({std::move(*came_to), otherwise, iterations}, world_.tissue);
  return LoadStepEnd::kUnderWay;
}

// Later rounds only if the solve moved nodes into a tool with a rigid patch; for the others the
// solver asks for the contacts itself (ContactUpdate).
LoadStepper::Solved LoadStepper::followTools(const RobotPose& pose, Checkpoint& good,
                                             IfUnconverged otherwise) {
  const double spacing = world_.tissue.lattice().spacing();
  for (int round = 1;; ++round) {
    world_.sticking.ride(pose, world_.tissue);
    if (round == 1) {
      expectTimeStep(durationOf(good.pose, pose));
      meet(pose, wayOfKnownPlaces());
    }
    pushRigid(pose);  // robot pose -> contacts -> loading patches
    std::vector<LoadingPatch> patches = patchesOfTools(world_);
    const std::vector<LoadingPatch>& before = world_.tissue.patches();
    const bool stands = round == 1 && !world_.tissue.isMoving();
    if (stands && !anyToolIn(patches, world_) && !anyToolIn(before, world_)) {
      return Solved::kFollows;
    }
    if (patches.empty()) patches = touchesAtRest(pose);
    if (round == 1) {
      good.shape = world_.tissue.shape();
      beginTimeStep(durationOf(good.pose, pose),
                    patches.empty() ? Touched::kByNone : Touched::kByTools);
      if (isRoundForNextCall()) return Solved::kLeftToNextCall;
    }
    follow(std::move(patches));  // loading patches -> solve
    if (settle(good, otherwise) == Solved::kLost) return Solved::kLost;
    if (!world_.tools.anyRigid() || world_.unfinished) return Solved::kFollows;
    const double deepest = deepestInRigid(pose);
    if (deepest <= tuning::kDeepEnough * spacing) return Solved::kFollows;
    const bool is_last = round == tuning::kRigidRounds || mayNotSolveOn();
    if (is_last) return deepest <= tuning::kThrough * spacing ? Solved::kFollows : Solved::kLost;
    world_.unfinished = !world_.tissue.isInTimeStep() && world_.isOutOfTime();
    if (world_.unfinished) return Solved::kFollows;
  }
}

// Solves on, kMoreSolves times at most, while the solve has not settled (ShapeJudge::isUnsettled).
// kLost, too, where a shape did not converge and that is refused. What moves and touches nothing
// gets nowhere that it may not: its steps are judged by their errors alone, as Tissue::wait does.
LoadStepper::Solved LoadStepper::settle(const Checkpoint& good, IfUnconverged otherwise) {
  if (world_.tissue.isInTimeStep() && isFree(world_)) return Solved::kFollows;
  for (int more = 0;; ++more) {
    if (judge_.isLost(good) || isRefused(otherwise)) return Solved::kLost;
    const bool is_last = more == tuning::kMoreSolves || mayNotSolveOn();
    if (is_last || !judge_.isUnsettled()) return Solved::kFollows;
    const bool converged = world_.tissue.lastReport().status != SolveStatus::kUnconverged;
    if (converged && world_.tissue.mayShowUnsettled()) {
      world_.tissue.noteUnsettled();
      return Solved::kFollows;
    }
    world_.unfinished = !world_.tissue.isInTimeStep() && world_.isOutOfTime();
    if (world_.unfinished) return Solved::kFollows;
    solveOn();
  }
}

bool LoadStepper::mayNotSolveOn() const {
  return world_.tissue.patience().left() == 0 || world_.tissue.isTimeStepOver();
}

void LoadStepper::solveOn() {
  std::vector<LoadingPatch> patches = patchesOfTools(world_);
  if (patches.empty()) patches = touchesAtRest(world_.pose);
  follow(std::move(patches));
}

// Finding the contacts, as of a mesh, may take so much of a call's time that solving for them would
// end after it: they are solved for first of all in the next one.
bool LoadStepper::isRoundForNextCall() const {
  return !world_.tools.anyRigid() && !world_.is_trial && !world_.tissue.isInTimeStep() &&
         world_.tissue.isRoundForNextCall();
}

// s: time between the poses. A robot that jumps would throw the tissue away: a tool that goes
// faster than a load step in kShortestTimeStep takes that for each.
double LoadStepper::durationOf(const RobotPose& from, const RobotPose& to) const {
  const double duration = to.stamp_s - from.stamp_s;
  if (!world_.tissue.hasTime() || !(duration > 0.0)) return duration;
  const double load_steps = WayLengths(world_).stepsBetween(from, to);
  return std::max(duration, tuning::kShortestTimeStep * std::min(1.0, load_steps));
}

void LoadStepper::expectTimeStep(double duration) {
  if (!world_.tissue.hasTime() || !(duration > 0.0)) return;
  world_.tissue.expectTimeStep(duration, Touched::kByTools);
}

// Without a duration the tools are elsewhere at once, as where they come in anew.
void LoadStepper::beginTimeStep(double duration, Touched touched) {
  if (!world_.tissue.hasTime() || !(duration > 0.0)) return;
  begins_free_ = touched == Touched::kByNone;
  world_.tissue.beginTimeStep(duration, touched);
}

// Ends the time step, if there is one. Whether it is to be made anew, shorter: not beside tools or
// supports, where a touch that begins or ends changes velocities at once, however short the step
// is.
bool LoadStepper::endsTooLong() {
  if (!world_.tissue.isInTimeStep()) return false;
  world_.tissue.endTimeStep();
  return begins_free_ && isFree(world_) && world_.tissue.isTimeStepRefused();
}

// Where time ran out on the way through rounds, the forces are of no shape that the tissue takes.
bool LoadStepper::isRefused(IfUnconverged otherwise) const {
  return world_.tissue.lastReport().status == SolveStatus::kUnconverged &&
         (otherwise == IfUnconverged::kRefuse || world_.isOutOfTime());
}

void LoadStepper::follow(std::vector<LoadingPatch> patches) {
  const Stopwatch watch(world_.report.solve_ms);
  world_.tissue.follow(std::move(patches), world_.sticking.left(), beddingOf(world_));
  world_.report.changed = true;
}

// How deep the shape is in tools with rigid patches (m): the others' touches are the solver's.
double LoadStepper::deepestInRigid(const RobotPose& pose) {
  return deepest(touch_finder_.stickingAt(pose, world_.sticking.displacement(world_.tissue)));
}

// Nodes under a tool with a rigid patch go out of it.
void LoadStepper::pushRigid(const RobotPose& pose) {
  if (!world_.tools.anyRigid()) return;
  for (int pass = 0; pass < tuning::kPushPasses; ++pass) {
    ContactSet contacts =
        touch_finder_.stickingAt(pose, world_.sticking.displacement(world_.tissue));
    auto& all = contacts.contacts;
    const double touches = tuning::kStaysOnRigid * world_.tissue.lattice().spacing();
    const auto is_off = [&](const Contact& contact) { return contact.depth_m < -touches; };
    all.erase(std::remove_if(all.begin(), all.end(), is_off), all.end());
    if (pass == 0) world_.sticking.keepTouching(contacts, world_.tissue);
    if (deepest(contacts) <= 0.0) break;
    world_.sticking.pushOut(contacts, world_.tissue, pose);
  }
  world_.sticking.tellEdges(pose, [&](int link, const Vec3& outward, const Vec3& point) {
    return edgesAround(pose, link, outward, point);
  });
}

// Of the flat face that presses there.
StickingContacts::Edges LoadStepper::edgesAround(const RobotPose& pose, int link,
                                                 const Vec3& outward, const Vec3& point) const {
  if (!world_.finder.hasFlatFaces(at(link))) return {};
  const double spacing = world_.tissue.lattice().spacing();
  const auto face = world_.finder.flatFace(at(link), pose.links[at(link)], -outward, point,
                                           tuning::kRimReach * spacing);
  if (!face) return {};
  RimLink pressing;
  pressing.facing = pressing.inwards = -outward;
  return {rimShare(*face, pressing, spacing), face->edges};
}

// There is no shape to go back to: one that is none of tissue is kept, and told as unconverged.
SolveReport LoadStepper::balance() {
  world_.sliding.ride(world_.pose, world_.tissue);
  world_.sticking.ride(world_.pose, world_.tissue);
  meet(world_.pose);
  world_.tissue.follow(patchesOfTools(world_), world_.tissue.freeNodes(), Bedding::kSupports);
  tearStretched(world_);
  if (judge_.isOfNoTissue()) world_.tissue.noteUnconverged();
  return world_.tissue.lastReport();
}

// How far a tool may have gone since the last search (m) for the places that it found to do for the
// first solve, after which is searched anew. Where nothing touched there may be no solve, and in a
// jam, as among tools that are thin for the lattice, all of it counts.
double LoadStepper::wayOfKnownPlaces() const {
  if (!anyToolIn(world_.tissue.patches(), world_)) return 0.0;
  if (world_.tissue.lastReport().status != SolveStatus::kOk) return 0.0;
  const double spacing = world_.tissue.lattice().spacing();
  bool any_mesh = false;
  for (std::size_t link = 0; link < world_.tools.linkCount(); ++link) {
    const double thickness = world_.thicknessNear(link, world_.pose.links[link]);
    if (thickness < tuning::kThickForPlaces * spacing) return 0.0;
    any_mesh = any_mesh || world_.finder.hasMesh(link);
  }
  return (any_mesh ? tuning::kKnownPlacesOnMesh : tuning::kKnownPlaces) * spacing;
}

void LoadStepper::meet(const RobotPose& pose, double way) {
  touch_finder_.beginStep();
  const std::vector<std::uint8_t> held = world_.sticking.heldNodes(world_.tissue);
  const ContactSet contacts = touch_finder_.touchesAt(pose, held, way);
  world_.sliding.meet(contacts, pose, world_.tissue, held,
                      touch_finder_.trackWandering(pose, contacts));
}

// Patches of all tools, also of those that touch nothing now, where they would touch the rest
// shape: the tissue comes back onto them. Else none.
std::vector<LoadingPatch> LoadStepper::touchesAtRest(const RobotPose& pose) {
  std::vector<LoadingPatch> patches;
  if (!touch_finder_.wouldTouchAtRest(pose)) return patches;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    patches.push_back(world_.sticking.loadingPatch(static_cast<int>(tool), world_.tissue));
    patches.back().contacts = world_.sliding.springsOf(static_cast<int>(tool));
  }
  return patches;
}

Checkpoint LoadStepper::toolsCheckpoint() const {
  return {
      world_.pose,           {}, world_.sticking.attachments(), world_.sliding, grasping_.jaws(),
      touch_finder_.depths()};
}

Checkpoint LoadStepper::checkpoint() const {
  Checkpoint all = toolsCheckpoint();
  all.shape = world_.tissue.shape();
  return all;
}

void LoadStepper::lieDown() {
  if (world_.tissue.isUntouched()) return;
  world_.sliding.ride(world_.pose, world_.tissue);
  meet(world_.pose);
  world_.tissue.follow(patchesOfTools(world_), {}, beddingOf(world_));
}

void LoadStepper::goBackTo(const Checkpoint& good) {
  world_.pose = good.pose;
  world_.reached_s = good.pose.stamp_s;
  world_.tissue.restore(good.shape);
  world_.sticking.restore(good.attachments, world_.tissue);
  world_.sliding = good.contacts;
  grasping_.restore(good.jaws);
  touch_finder_.restoreDepths(good.depths);
}

}  // namespace robot_tissue
