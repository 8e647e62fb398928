// ToolMotion: tools that no shape follows, or that drag tissue with them, let go and come in anew.
#include <utility>

#include "box_distance.h"
#include "tool_motion.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Those of the tools that were among them in so many updates in a row; for these it begins anew.
std::vector<std::size_t> inARow(const std::vector<std::size_t>& tools, int updates, std::size_t all,
                                std::vector<int>& counts) {
  std::vector<int> before = std::exchange(counts, std::vector<int>(all, 0));
  before.resize(all, 0);
  std::vector<std::size_t> often;
  for (const std::size_t tool : tools) {
    if (before[tool] + 1 >= updates) {
      often.push_back(tool);
    } else {
      counts[tool] = before[tool] + 1;
    }
  }
  return often;
}

}  // namespace

// Where no shape could follow, tools that have come out of the tissue by themselves let go, but for
// what graspers hold.
void ToolMotion::leaveStuck(RobotPose& pose) {
  RobotPose from = *world_.last_pose;
  bool any = false;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (grasping_.grasps(tool)) continue;
    const RobotPose moved = world_.tools.withTool(tool, pose, from);
    if (ways_.stepsBetween(from, moved) == 0.0 || overlap_.isInTissue(tool, pose)) continue;
    any = true;
    from = moved;
    letGoOf(tool);
  }
  if (!any) return;
  world_.last_pose = from;
  if (load_step_.advance(from) != LoadStepEnd::kArrived) {
    if (world_.tissue.patience().cutsOff()) return;  // all would meet the jam anew
    startAnew(pose, Entry::kLetGo);
  }
  world_.report.lost = false;  // unless the others are still
  world_.last_pose = walk(pose);
}

// Tools that fall behind on their way out of the tissue, and are clear of it where the robot has
// them, let go: without them it comes to the same in the end. What a tool holds, and blades in
// their wounds, are followed.
void ToolMotion::leaveBehind(RobotPose& pose) {
  std::vector<std::size_t> clear;
  if (world_.report.too_fast && world_.report.jumped.empty() && !world_.tools.anyRigid()) {
    for (const std::size_t tool : toolsBehind()) {
      if (ways_.touchesTissue(tool) && !isAttached(tool) && overlap_.isClear(tool, pose)) {
        clear.push_back(tool);
      }
    }
  }
  const std::vector<std::size_t> left =
      inARow(clear, tuning::kMostClearInARow, world_.tools.size(), behind_.clear_in_a_row);
  if (left.empty()) return;
  RobotPose from = *world_.last_pose;
  for (const std::size_t tool : left) {
    from = world_.tools.withTool(tool, pose, from);
    letGoOf(tool);
    addOnce(tool, world_.report.left);
  }
  world_.last_pose = from;
  const LoadStepEnd end = load_step_.advance(from);
  if (end == LoadStepEnd::kUnderWay || end == LoadStepEnd::kOutOfTime) return;
  world_.report.too_fast = false;
  if (end != LoadStepEnd::kArrived) startAnew(pose, Entry::kLetGo);
  world_.last_pose = walk(pose);
}

// Whether the tool drags tissue with it that it stands through: it pushes, is more than a spacing
// away from where the tissue is at rest, and deeper in its surface than ShapeJudge lets it.
bool ToolMotion::isHooked(std::size_t tool) const {
  if (!world_.sliding.pushes(static_cast<int>(tool), world_.tissue)) return false;
  std::vector<std::size_t> links;
  for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool); ++link) {
    if (world_.isInWound(link)) return false;
    const Box box = world_.finder.bounds(link, world_.last_pose->links[link]);
    if (distance(box, world_.tissue.lattice().bounds()) < world_.tissue.lattice().spacing()) {
      return false;
    }
    links.push_back(link);
  }
  return judge_.isAnyThrough(links, *world_.last_pose);
}

void ToolMotion::letGoOf(std::size_t tool) {
  world_.dead_end.reset();
  load_step_.forgetUnderWay();
  world_.sticking.letGo(static_cast<int>(tool));
  world_.sliding.clear(static_cast<int>(tool));
  grasping_.forgetJaws(tool);
}

// A tool that drags tissue out with it that stands through it, as where it went beneath fixed
// nodes, lets go.
void ToolMotion::unhook(RobotPose& pose) {
  std::vector<std::size_t> hooked;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!isHooked(tool)) continue;
    hooked.push_back(tool);
    addOnce(tool, world_.report.hooked);
  }
  if (!hooked.empty()) comeAnew(hooked, pose);
}

// Tissue that hangs on what a grasper holds goes through its jaws: where no shape follows it out of
// them when they are told to let go, it comes back without them.
void ToolMotion::leaveReleased(RobotPose& pose) {
  std::vector<std::size_t> released;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (grasping_.jaws()[tool].let_go) released.push_back(tool);
  }
  if (released.empty()) return;
  world_.report.lost = false;
  comeAnew(released, pose);
}

// Tools that no shape follows again and again are on ways that lead through what has no room, as
// one that was thrown to the other side of the tissue. What a tool holds, and blades in their
// wounds, stay; so do all where work is bounded for a scene, of which this takes a good part.
void ToolMotion::leaveJam(RobotPose& pose) {
  if (world_.tools.anyRigid() || world_.tissue.patience().isForScene()) return;
  std::vector<std::size_t> behind;
  for (std::size_t tool = 0; tool < world_.tools.size() && world_.report.lost; ++tool) {
    if (!ways_.isAt(tool, *world_.last_pose, pose) && !isAttached(tool)) behind.push_back(tool);
  }
  const std::vector<std::size_t> jammed =
      inARow(behind, tuning::kMostLostInARow, world_.tools.size(), behind_.lost_in_a_row);
  if (jammed.empty()) return;
  for (const std::size_t tool : jammed) addOnce(tool, world_.report.jammed);
  world_.report.lost = false;
  comeAnew(jammed, pose);
}

// Whether it holds tissue, or is in a wound of its own.
bool ToolMotion::isAttached(std::size_t tool) const {
  if (world_.sticking.holds(static_cast<int>(tool))) return true;
  for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool); ++link) {
    if (world_.isInWound(link)) return true;
  }
  return false;
}

// The tissue comes back without these tools, and what they still meet they meet from outside.
void ToolMotion::comeAnew(const std::vector<std::size_t>& tools, RobotPose& pose) {
  RobotPose without = *world_.last_pose;
  for (const std::size_t tool : tools) {
    without = world_.tools.withTool(tool, world_.tools.complete({}), without);
    letGoOf(tool);
  }
  world_.last_pose = without;
  if (load_step_.advance(without) == LoadStepEnd::kArrived) {
    comeAndGo(pose, Entry::kLetGo);
  } else if (world_.tissue.patience().cutsOff()) {
    world_.report.lost = true;
    return;  // as in leaveStuck
  } else {
    startAnew(pose, Entry::kLetGo);
  }
  world_.last_pose = walk(pose);
}

}  // namespace robot_tissue
