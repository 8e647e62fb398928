#include "tool_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/pipeline/between.h"
#include "tuning.h"

namespace robot_tissue {

// Whether a load step like the last one, before which so much was left, would end too late.
bool ToolMotion::isShort(double before_ms) const {
  const double left_ms = world_.deadline.leftMs();
  return std::isfinite(left_ms) && left_ms < tuning::kOfLastLoadStep * (before_ms - left_ms);
}

// Whether the shortest load step of this way is the one that no shape followed (World::dead_end):
// it is not tried again.
bool ToolMotion::leadsNowhere(const RobotPose& from, const RobotPose& to) const {
  if (!world_.dead_end || ways_.stepsBetween(world_.dead_end->from, from) > 0.0) return false;
  const double steps = ways_.stepsBetween(from, to);
  const RobotPose shortest =
      steps > tuning::kShortestStep ? between(from, to, tuning::kShortestStep / steps) : to;
  return ways_.stepsBetween(world_.dead_end->to, shortest) < 0.5 * tuning::kShortestStep;
}

// Puts tools whose way touches nothing (passesBy) at its end in `start`. True: those are all.
bool ToolMotion::letPass(RobotPose& start, const RobotPose& pose) const {
  bool all_pass = !world_.tools.anyRigid();
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (ways_.passesBy(tool, start, pose)) {
      start = world_.tools.withTool(tool, pose, start);
    } else {
      all_pass = false;
    }
  }
  return all_pass;
}

// Where the tissue has followed the tools to.
const RobotPose& ToolMotion::reached() const {
  return world_.tools.anyRigid() ? behind_.checkpoints.back().pose : *world_.last_pose;
}

// Load steps up to the pose, shorter ones where no shape follows. Returns how far it came, at all
// or in time. Tools that pass the tissue by take none.
RobotPose ToolMotion::walk(const RobotPose& pose) {
  RobotPose start = reached();
  world_.asked = pose;
  const bool goes_back = turnsBack(start, pose);
  behind_.last_goal = pose;
  const bool moves = world_.tissue.isMoving();
  if (!moves) letPass(world_.pose, pose);  // wherever the others come to
  if (!moves && letPass(start, pose)) {
    passTo(pose);
    return pose;
  }
  if (goes_back) forgetUnfinished();
  if (!moves && !finishes(start, pose)) return start;
  if (!moves && leadsNowhere(start, pose)) {
    world_.report.lost = true;
    return start;
  }
  return walkFrom(start, pose);
}

// Whether the tools go back: what time ran out in on the way there they need not wait for.
bool ToolMotion::turnsBack(const RobotPose& start, const RobotPose& pose) const {
  if (behind_.last_goal.links.size() != pose.links.size()) return false;
  return ways_.stepsBetween(behind_.last_goal, pose) >
         std::max(ways_.stepsBetween(start, pose), ways_.stepsBetween(start, behind_.last_goal));
}

void ToolMotion::forgetUnfinished() {
  load_step_.forgetUnderWay();
  world_.unfinished = false;
  behind_.late_iterations = 0;
}

// Ends the last load step, if time ran out in it, before the next one begins: errors of steps that
// were cut short would add up. Not one that leads away from the pose, as of tools that go back.
// False: there is no time left for a next one.
bool ToolMotion::finishes(RobotPose& start, const RobotPose& pose) {
  const bool is_late = std::exchange(world_.unfinished, false);
  if (load_step_.isUnderWay()) {
    const double left = ways_.stepsBetween(start, pose);
    const bool leads_away = ways_.stepsBetween(load_step_.goesTo(), pose) > left;
    const bool stays = ways_.stepsBetween(start, load_step_.goesTo()) == 0.0;
    const bool holds_up = stays && left > 0.0 && behind_.late_iterations > tuning::kMostToFinish;
    if (leads_away || holds_up) load_step_.forgetUnderWay();
  }
  const bool may_end = !is_late || behind_.late_iterations > tuning::kMostToFinish;
  if (!load_step_.isUnderWay() && may_end) {
    behind_.late_iterations = 0;
    return true;
  }
  const double before_ms = world_.deadline.leftMs();
  const LoadStepEnd end = load_step_.finish(start);
  const bool arrived = end == LoadStepEnd::kArrived;
  const int made = world_.tissue.lastReport().iterations;
  behind_.late_iterations += std::max(1, made);
  letPass(world_.pose, pose);  // the load step began before they passed
  if (arrived) start = world_.pose;
  const bool is_done = arrived && !world_.unfinished;
  if (is_done) behind_.late_iterations = 0;
  const bool is_short =
      isShort(before_ms) || (isBounded() && made > tuning::kShortToGoOn * world_.mostIterations());
  if (is_done && !is_short) return true;
  behind_.begins_short = end == LoadStepEnd::kOutOfTime || end == LoadStepEnd::kNoShape;
  world_.report.too_fast = !world_.report.lost;
  return false;
}

LoadStepEnd ToolMotion::finishStanding() {
  const RobotPose stands = world_.last_pose.value_or(world_.pose);
  const LoadStepEnd end = load_step_.finish(stands);
  letPass(world_.pose, stands);  // a load step under way began before they passed
  if (end == LoadStepEnd::kArrived && world_.last_pose) world_.last_pose = world_.pose;
  return end;
}

// Whether an update leaves what a load step has no iterations for to the next one.
bool ToolMotion::isBounded() const { return world_.mostIterations() > 0; }

void ToolMotion::checkIn(const RobotPose& pose) {
  if (!world_.tools.anyRigid() || world_.tissue.isUntouched()) behind_.checkpoints.clear();
  if (behind_.checkpoints.size() >= tuning::kMostCheckpoints)
    behind_.checkpoints.erase(behind_.checkpoints.begin());
  behind_.checkpoints.push_back(world_.tools.anyRigid() ? load_step_.checkpoint() : Checkpoint());
  behind_.checkpoints.back().pose = pose;
}

// The tools let go, and come in from outside. Those that wait for the next step stay away in the
// pose.
void ToolMotion::startAnew(RobotPose& pose, Entry entry) {
  world_.dead_end.reset();
  load_step_.forgetUnderWay();
  world_.sticking.clear();
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    world_.sliding.clear(static_cast<int>(tool));
  }
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) grasping_.forgetJaws(tool);
  world_.pose = world_.tools.complete({});
  if (!world_.reached_s || *world_.reached_s > pose.stamp_s) world_.reached_s = pose.stamp_s;
  world_.pose.stamp_s = *world_.reached_s;
  load_step_.lieDown();
  behind_.checkpoints.clear();
  world_.last_pose = pose;
  world_.last_pose->stamp_s = *world_.reached_s;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (waitsOutside(tool, tool > 0 ? Others::kCame : Others::kNone, pose)) {
      world_.last_pose = world_.tools.withTool(tool, pose, *world_.last_pose);
    } else {
      resolveOverlap(tool, entry, *world_.last_pose);
    }
  }
  // Nothing sticks to where they were before.
  world_.sliding.commit(*world_.last_pose, world_.tissue);
  checkIn(*world_.last_pose);
}

// A tool that is in the tissue there is outside of it in the pose, and told to come in from there.
void ToolMotion::resolveOverlap(std::size_t tool, Entry entry, RobotPose& pose) {
  const auto jaws = grasping_.areShut(tool, pose) ? OverlapResolver::JawsStand::kShut
                                                  : OverlapResolver::JawsStand::kApart;
  if (!overlap_.resolveOverlap(tool, jaws, pose)) return;
  grasping_.comeBackAround(tool, pose);
  StepReport& report = world_.report;
  const auto& hooked = report.hooked;
  if (std::find(hooked.begin(), hooked.end(), tool) != hooked.end()) return;
  addOnce(tool, entry == Entry::kAppears ? report.were_inside : report.jammed);
}

// A tool that stood nowhere, or jumped, comes in from outside, one that stands nowhere now lets go;
// the others stay as they are.
void ToolMotion::comeAndGo(RobotPose& pose, Entry entry, const std::vector<std::size_t>& jumped) {
  RobotPose from = *world_.last_pose;
  bool any = false;
  Others came = Others::kNone;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    const std::size_t first = world_.tools.firstLink(tool), end = world_.tools.endLink(tool);
    const bool jumps = std::find(jumped.begin(), jumped.end(), tool) != jumped.end();
    const bool stays =
        first == end || ToolSet::isAway(from.links[first]) == ToolSet::isAway(pose.links[first]);
    if (stays && !jumps) continue;
    if (waitsOutside(tool, came, pose) && !jumps) continue;
    any = true;
    if (!ToolSet::isAway(pose.links[first])) came = Others::kCame;
    from = world_.tools.withTool(tool, pose, from);
    letGoOf(tool);
    resolveOverlap(tool, entry, from);
  }
  if (!any) return;
  world_.last_pose = from;
  world_.sliding.commit(from, world_.tissue);
  behind_.checkpoints.clear();
  checkIn(from);
}

bool ToolMotion::standsStill(const RobotPose& pose) const {
  if (!world_.last_pose) return false;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!ways_.isAt(tool, world_.asked, pose)) return false;
  }
  return true;
}

std::vector<std::size_t> ToolMotion::toolsBehind() const {
  std::vector<std::size_t> behind;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!ways_.isAt(tool, world_.pose, world_.asked)) behind.push_back(tool);
  }
  return behind;
}

// Looking for the way out of the tissue takes time: a tool that there is none for stays away in the
// pose, and is behind, once another one came in this step.
bool ToolMotion::waitsOutside(std::size_t tool, Others others, RobotPose& pose) {
  const bool comes = !ToolSet::isAway(pose.links[world_.tools.firstLink(tool)]);
  if (!comes || others == Others::kNone || !world_.deadline.isOver()) return false;
  pose = world_.tools.withTool(tool, world_.tools.complete({}), std::move(pose));
  world_.report.too_fast = true;
  return true;
}

void ToolMotion::passTo(const RobotPose& pose) {
  world_.pose = pose;
  world_.unfinished = false;
  world_.reached_s = pose.stamp_s;
  world_.sliding.pass(pose);
  grasping_.openJaws();
  grasping_.closeJaws();
}

// Takes up the shape at the checkpoint nearest to the pose, and drops the later ones.
void ToolMotion::goBackTo(RobotPose& pose) {
  std::size_t nearest = behind_.checkpoints.size() - 1;
  double shortest = ways_.stepsBetween(reached(), pose);
  for (std::size_t earlier = nearest; world_.tools.anyRigid() && earlier-- > 0;) {
    const double way = ways_.stepsBetween(behind_.checkpoints[earlier].pose, pose);
    if (way < shortest) {
      shortest = way;
      nearest = earlier;
    }
  }
  if (world_.tools.anyRigid()) {
    behind_.checkpoints.erase(
        behind_.checkpoints.begin() + static_cast<std::ptrdiff_t>(nearest) + 1,
        behind_.checkpoints.end());
    load_step_.goBackTo(behind_.checkpoints.back());
  }
  const auto far = ways_.farFrom(reached(), pose);
  if (far.empty()) return;
  world_.report.too_fast = true;
  world_.report.jumped = far;
  world_.tools.anyRigid() ? startAnew(pose) : comeAndGo(pose, Entry::kAppears, far);
}

std::optional<Checkpoint> ToolMotion::lastGood() const {
  return world_.tools.anyRigid() ? std::optional(load_step_.checkpoint()) : std::nullopt;
}

// Unless the way from the checkpoint came nearer to the goal.
void ToolMotion::stayAt(const Checkpoint& last_good, const RobotPose& goal) {
  const bool came_nearer =
      ways_.stepsBetween(*world_.last_pose, goal) < ways_.stepsBetween(last_good.pose, goal);
  if (came_nearer || !world_.report.jumped.empty()) return;
  load_step_.goBackTo(last_good);
  world_.last_pose = last_good.pose;
}

void ToolMotion::checkInAnew() {
  behind_.checkpoints.clear();
  if (world_.last_pose) checkIn(*world_.last_pose);
}

}  // namespace robot_tissue
