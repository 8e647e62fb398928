// Pipeline: what tools are told, to grasp, to let go and to push by a force.
#include <optional>
#include <string>
#include <vector>

#include "pipeline_parts.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tool_reports.h"

namespace robot_tissue {
namespace {

// The driven tools; one that stands nowhere goes nowhere.
std::vector<std::size_t> standingOf(const ForceDrive& drive, const RobotPose& told,
                                    const ToolSet& tools) {
  std::vector<std::size_t> standing;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    const bool is_away = ToolSet::isAway(told.links[tools.firstLink(tool)]);
    if (drive.drives(tool) && !is_away) standing.push_back(tool);
  }
  return standing;
}

}  // namespace

void Pipeline::grasp(std::size_t tool) {
  const std::string name = "tool '" + world_.tools.nameOf(tool) + "'";
  if (!world_.tools[tool].role.holds) {
    throw InputError(name + ": its role is " + world_.tools[tool].role.name +
                     "; allowed: a tool with the role " + toolRolesWith(&ToolRole::holds));
  }
  if (!world_.last_pose) throw InputError(name + ": has no pose yet; allowed: a tool that stands");
  parts_->load_step.forgetUnderWay();  // in which the tool does not hold
  if (!parts_->grasping.grasp(tool)) {
    const std::string why = parts_->grasping.whyItHoldsNothing(tool, true);
    throw InputError(name + ": holds nothing: " +
                     (why.empty() ? "its jaws stand nowhere or have no shapes" : why) +
                     "; allowed: jaws around tissue");
  }
  state_.touched = true;
  describeTools();
}

void Pipeline::letGo(std::size_t tool) {
  parts_->load_step.forgetUnderWay();  // in which the tool holds
  if (!parts_->grasping.letGo(tool)) return;
  state_.touched = true;
  describeTools();
}

void Pipeline::push(std::size_t tool, const std::optional<Vec3>& force) {
  if (force && !(force->norm() > 0.0 && force->allFinite())) {
    throw InputError("tool '" + world_.tools.nameOf(tool) +
                     "': the force is zero or not finite; allowed: a force");
  }
  const ToolRole& role = world_.tools[tool].role;
  if (force && !role.touches()) {
    throw InputError("tool '" + world_.tools.nameOf(tool) + "': role " + role.name + " only " +
                     role.deed() + "; allowed: a tool that pushes");
  }
  state_.drive.push(tool, force);
  state_.touched = true;
}

// True: a driven tool has a way left to go. Without time a correction goes on from where the last
// one led. In time that would leave the tissue where it is: the update is made again, to another
// end, unless it changed the tissue itself.
bool Pipeline::drive(const RobotPose& pose, const Checkpoint* before) {
  bool goes_on = false;
  const bool in_time = world_.tissue.isInTime();
  const bool may_repeat = before != nullptr && before->shape.cells == world_.tissue.state().cells;
  const StepReport& report = world_.report;
  const RobotPose told = world_.tools.complete(pose);
  const std::vector<std::size_t> driven = standingOf(state_.drive, told, world_.tools);
  for (const std::size_t tool : driven) {
    if (in_time && !may_repeat) {
      goes_on = goes_on || !state_.drive.isMet(tool, answerOf(world_, tool).force);
      continue;
    }
    if (state_.drive.waits(tool, isLate())) {
      goes_on = true;
      continue;
    }
    const auto walk = [&] {
      world_.report.lost = false;  // where a shape follows back, none is lost any more
      if (in_time) {
        parts_->load_step.goBackTo(*before);
        world_.last_pose = before->pose;
      }
      world_.last_pose = parts_->motion.walk(state_.drive.driven(told, world_.tools));
      return !report.too_fast && !report.lost && !world_.deadline.isOver();
    };
    const std::size_t link = world_.tools.firstLink(tool);
    const bool on = state_.drive.meetForce(
        tool, {parts_->ways.stepOf(link, world_.pose.links[link]),
               [&] { return answerOf(world_, tool).force; }, walk, [&] { return report.lost; }});
    goes_on = goes_on || on;
  }
  for (const std::size_t tool : driven) {
    const bool is_off = state_.drive.isPushedOff(tool, answerOf(world_, tool).force);
    goes_on = goes_on || is_off;
  }
  return goes_on;
}

}  // namespace robot_tissue
