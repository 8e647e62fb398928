#include "robot_tissue/pipeline/pipeline.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "landing.h"
#include "pipeline_parts.h"
#include "stopwatch.h"
#include "tool_reports.h"
#include "tuning.h"

namespace robot_tissue {

Pipeline::Pipeline(const TissueConfig& tissue, const SolverConfig& solver,
                   const std::vector<ToolGeometry>& tools,
                   const std::vector<SupportConfig>& supports)
    : parts_(std::make_unique<Parts>(tissue, solver)),
      world_(parts_->world),
      state_(parts_->state),
      supports_(supports) {
  takeTools(tools);
  world_.tissue.setContactUpdate(&parts_->contact_update);
  landing_ = Landing::ofScene(tissue, solver, supports_);
}

Pipeline::~Pipeline() = default;

void Pipeline::takeTools(const std::vector<ToolGeometry>& tools) {
  world_.setTools(tools, supports_);
  state_.drive.setTools(tools.size());
  parts_->grasping.setTools(tools.size());
  parts_->blades.forget();
  parts_->burrs.forget();
  parts_->scissors.forget();
  state_.touches = TouchState();
  state_.gave_up = state_.was_near = false;
  state_.late_iterations = 0;
}

void Pipeline::setTools(const std::vector<ToolGeometry>& tools) {
  endTrial();
  takeTools(tools);
  parts_->load_step.lieDown();
  world_.last_pose.reset();
  parts_->motion.forget();
  parts_->load_step.forgetUnderWay();
  state_.touched = true;
}

Pose Pipeline::away() { return ToolSet::away(); }
bool Pipeline::isAway(const Pose& pose) { return ToolSet::isAway(pose); }

const std::vector<std::string>& Pipeline::toolWarnings() const { return world_.warnings; }

const std::vector<ToolGeometry>& Pipeline::tools() const { return world_.tools.geometry(); }

const Tissue& Pipeline::tissue() const { return world_.tissue; }

const StepReport& Pipeline::report() const { return world_.report; }

const std::optional<RobotPose>& Pipeline::pose() const { return world_.last_pose; }

ForceBalance Pipeline::forceBalance() const { return forceBalanceOf(world_); }

void Pipeline::limitPatience(double times) { world_.tissue.patience().limit(times); }

void Pipeline::setEnd(const Deadline& end) {
  end_ = end;
  world_.tissue.setDeadline(end_);
}

const StepReport& Pipeline::step(const RobotPose& pose) {
  const RobotPose goal = state_.drive.driven(world_.tools.complete(pose), world_.tools);
  const bool stands = parts_->motion.standsStill(goal) && !state_.touched;
  beginReport(stands);
  const bool time_passes =
      world_.tissue.isMoving() && goal.stamp_s > world_.reached_s.value_or(goal.stamp_s);
  if (stands && !isLate() && !time_passes) {
    if (world_.last_pose) world_.last_pose->stamp_s = world_.pose.stamp_s = goal.stamp_s;
    world_.reached_s = goal.stamp_s;
    return world_.report;
  }
  const Bounded bounded(*this);
  world_.tools_move = !stands && !state_.drive.drivesAny();
  if (world_.tissue.isLoading()) loadOn();
  if (stands && !world_.tissue.isMoving()) {
    finish();
    countLate();
  } else {
    state_.late_iterations = 0;
    state_.gave_up = false;
    stepTo(goal, pose);
  }
  return endReport();
}

void Pipeline::beginReport(bool tools_stand) {
  StepReport report;
  report.changed = state_.touched;
  report.gave_up = state_.gave_up;
  report.hopeless = world_.tissue.patience().cutsOff();
  // Not once all are where the robot has them, as where the tissue let go of them.
  report.lost = tools_stand && world_.report.lost && !world_.report.behind.empty();
  if (report.lost) report.behind = std::move(world_.report.behind);
  report.tools = std::move(world_.report.tools);                    // till they are described anew
  report.would_take_all = std::move(world_.report.would_take_all);  // till burrs go on
  world_.report = std::move(report);
}

const StepReport& Pipeline::endReport() {
  const bool is_cut_short = world_.tissue.isMoving() &&  // its last time step
                            world_.tissue.lastReport().status == SolveStatus::kLate;
  world_.report.late = isLate() || is_cut_short;
  world_.report.gave_up = state_.gave_up;
  world_.report.hopeless = world_.tissue.patience().cutsOff();
  return world_.report;
}

// goal: the pose, with the ways of tools that a force drives.
void Pipeline::stepTo(const RobotPose& goal, const RobotPose& pose) {
  if (state_.touched) world_.dead_end.reset();
  world_.report.changed = world_.report.changed || !world_.tissue.isUntouched();
  const std::size_t dropped = world_.tissue.droppedPieces().size();
  RobotPose there = goal;  // but for tools that wait outside
  parts_->blades.comeIn(there);
  if (!world_.last_pose || !parts_->motion.hasCheckpoints()) {
    parts_->motion.startAnew(there);
  } else {
    parts_->motion.comeAndGo(there);
  }
  std::optional<Checkpoint> before;
  if (state_.drive.drivesAny() && world_.tissue.hasTime() &&
      there.stamp_s > world_.reached_s.value_or(there.stamp_s)) {
    before = parts_->load_step.checkpoint();
  }
  const bool arrived = goInLegs(there);
  world_.asked = goal;
  state_.told = pose;
  // Shapes to go back to may have patches on what was dropped.
  if (world_.tissue.droppedPieces().size() > dropped) parts_->motion.checkInAnew();
  // There is a way left to go.
  state_.touched = !arrived || world_.report.too_fast || drive(pose, before ? &*before : nullptr);
  if (world_.report.too_fast || world_.report.lost) {
    world_.report.behind = parts_->motion.toolsBehind();
  } else {
    parts_->grasping.forgetLetGo();
  }
  if (world_.report.lost && state_.drive.drivesAny()) {
    state_.drive.noteReached(world_.tools.complete(pose), *world_.last_pose, world_.tools);
    state_.drive.stay();
    world_.asked = state_.drive.driven(world_.tools.complete(pose), world_.tools);
  }
  expectTouch();
  describeTools();
}

SolveReport Pipeline::wait(double duration) {
  if (world_.tools.size() == 0 && !world_.has_supports) {
    const Bounded bounded(*this);
    const SolveReport report = world_.tissue.wait(duration);
    describeTools();
    return report;
  }
  RobotPose pose = world_.last_pose ? state_.told : RobotPose();
  pose.stamp_s = world_.reached_s.value_or(0.0) + duration;
  step(pose);
  return world_.tissue.lastReport();
}

void Pipeline::startClock(double seconds) { world_.reached_s = seconds; }

void Pipeline::stopTime() {
  if (!world_.tissue.hasTime()) return;
  world_.tissue.stopTime();
  state_.touched = true;
}

void Pipeline::load(const LoadStep& step, const Tissue::OnIncrement& on_increment,
                    int most_increments) {
  const Bounded bounded(*this);
  world_.tissue.load(
      step,
      [&](int increment, int increments, const SolveReport& report) {
        world_.sliding.commit(world_.pose, world_.tissue);
        world_.sliding.ride(world_.pose, world_.tissue);
        describeTools();
        if (on_increment) on_increment(increment, increments, report);
      },
      most_increments);
  touch();
}

// A change of the tissue, which is in balance after it; what the change let loose comes to lie.
SolveReport Pipeline::changeTissue(const std::function<SolveReport()>& change) {
  const Bounded bounded(*this);
  const std::optional<Tissue::Shape> before = shapeOfLoose();
  const SolveReport report = comeToLie(before, change());
  touch();
  return report;
}

SolveReport Pipeline::release(const std::vector<std::string>& names) {
  return changeTissue([&] { return world_.tissue.release(names); });
}

CutReport Pipeline::cut(const std::vector<Vec3>& corners) {
  CutReport report;
  const SolveReport solve = changeTissue([&] {
    report = world_.tissue.cut(corners);
    return report.solve;
  });
  report.solve = solve;
  return report;
}

RemoveReport Pipeline::remove(const RemovedSpace& space) {
  RemoveReport report;
  const SolveReport solve = changeTissue([&] {
    report = world_.tissue.remove(space);
    return report.solve;
  });
  report.solve = solve;
  return report;
}

SolveReport Pipeline::undo(int count) {
  return changeTissue([&] { return world_.tissue.undo(count); });
}

SutureResult Pipeline::suture(const SutureConfig& config) {
  const Bounded bounded(*this);
  const SutureResult result = world_.tissue.suture(config);
  touch();
  return result;
}

double Pipeline::stepsTo(const RobotPose& pose) const {
  return world_.last_pose ? parts_->ways.stepsBetween(
                                *world_.last_pose,
                                state_.drive.driven(world_.tools.complete(pose), world_.tools))
                          : 0.0;
}

std::vector<std::size_t> Pipeline::jumpsTo(const RobotPose& pose) const {
  return world_.last_pose
             ? parts_->ways.farFrom(*world_.last_pose,
                                    state_.drive.driven(world_.tools.complete(pose), world_.tools))
             : std::vector<std::size_t>();
}

double Pipeline::freeStepsTo(const RobotPose& pose) const {
  return world_.last_pose ? parts_->ways.freeSteps(
                                *world_.last_pose,
                                state_.drive.driven(world_.tools.complete(pose), world_.tools))
                          : 0.0;
}

bool Pipeline::isInTissue(std::size_t tool, const RobotPose& pose) const {
  return parts_->overlap.isInTissue(tool, world_.tools.complete(pose));
}

std::optional<StillPose> Pipeline::stillPose() const {
  const bool is_driven = state_.drive.drivesAny();
  const bool stands = !state_.touched && !isLate() && !is_driven && !world_.tissue.isMoving();
  if (!world_.last_pose || !stands) return std::nullopt;
  RobotPose of_tools = world_.asked;
  of_tools.links.resize(world_.tools.linkCount());
  std::vector<double> reach;
  for (std::size_t link = 0; link < of_tools.links.size(); ++link) {
    reach.push_back(world_.reach(link));
  }
  return StillPose(std::move(of_tools), std::move(reach),
                   tuning::kStandsStill * world_.tissue.lattice().spacing());
}

void Pipeline::reset() {
  forgetTools();
  world_.tissue.reset();
  meetNewTissue();
  describeTools();
}

SolveReport Pipeline::loadState(const std::string& bytes) {
  const std::shared_ptr<const SavedState> saved = world_.tissue.readState(bytes);
  forgetTools();
  const Bounded bounded(*this);
  const SolveReport report = world_.tissue.loadState(*saved);
  meetNewTissue();
  describeTools();
  return report;
}

void Pipeline::takeOver(const Tissue& other, Tissue::Displacements displacement) {
  forgetTools();
  world_.tissue.takeOver(other);
  putInPlace(std::move(displacement), world_.tissue.state().cells);
  meetNewTissue();
  describeTools();
}

// Once no tool touches: no touch is to be brought onto the new surface in the first solve.
void Pipeline::meetNewTissue() {
  parts_->contact_update.beginAnew();
  world_.sliding.commit(world_.pose, world_.tissue);
}

// They hold and touch nothing, and come in from outside: nothing that was before is any matter.
void Pipeline::forgetTools() {
  endTrial();
  world_.sticking.clear();
  world_.sliding.clear();
  world_.forgetSearches();
  state_.touches = TouchState();
  parts_->grasping.meetNewTissue();
  state_.drive.setTools(world_.tools.size());
  parts_->blades.forget();
  parts_->burrs.forget();
  parts_->scissors.forget();
  parts_->motion.forget();
  parts_->load_step.forgetUnderWay();
  world_.last_pose.reset();
  world_.asked = world_.pose = world_.tools.complete({});
  world_.report.lost = false;
  world_.report.behind.clear();
  world_.unfinished = state_.gave_up = false;
  state_.late_iterations = 0;
  state_.touched = true;
  state_.was_near = false;
}

// After the tissue, or friction, changed by other means than the tools' motion.
void Pipeline::touch() {
  parts_->load_step.forgetUnderWay();  // begun as it was before
  // A shape that is taken back bit for bit is not solved for, so nobody asked for its contacts.
  parts_->contact_update.takeSurface();
  world_.sliding.commit(world_.pose, world_.tissue);
  state_.touched = true;
  state_.gave_up = false;
  state_.late_iterations = 0;
  parts_->motion.checkInAnew();
  parts_->blades.endStrokes();
  parts_->burrs.endStrokes();
  parts_->scissors.endStrokes();
  describeTools();
}

void Pipeline::describeTools() {
  const double before_ms = world_.report.contact_ms;
  {
    const Stopwatch watch(world_.report.contact_ms);
    if (world_.last_pose && state_.drive.drivesAny()) {
      state_.drive.noteReached(world_.tools.complete(state_.told), *world_.last_pose, world_.tools);
    }
    for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
      ToolReport& report = world_.report.tools[tool];
      report = describeTool(world_, parts_->grasping, tool);
      report.offset = state_.drive.came(tool);
      report.unanswered = state_.drive.isUnanswered(tool);
      parts_->blades.describe(tool, report);
      limitWrench(world_.tools[tool].max_force, report);
    }
  }
  world_.depths_are_due = true;
  if (!leaves_depths_) findDepths();
  state_.reporting_ms = world_.report.contact_ms - before_ms;
}

void Pipeline::findDepths() const {
  if (!std::exchange(world_.depths_are_due, false)) return;
  const Stopwatch watch(world_.report.contact_ms);
  const std::vector<double> deepest = deepestPoints(world_, parts_->touch_finder);
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    world_.report.tools[tool].max_penetration = deepest[tool];
  }
}

}  // namespace robot_tissue
