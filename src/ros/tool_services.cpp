// TissueServices: those that act on a tool.
#include <string>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/request_checks.h"
#include "robot_tissue/ros/tissue_services.h"
#include "robot_tissue/ros/tool_forces.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

std::string inQuotes(const std::string& name) { return "'" + shortText(name) + "'"; }

std::string listed(const std::vector<ToolConfig>& tools) {
  std::string list;
  for (const ToolConfig& tool : tools) list += (list.empty() ? "" : ", ") + tool.name;
  return list.empty() ? "none, the scene has no tools" : list;
}

}  // namespace

bool TissueServices::isTool(const std::string& name) const {
  for (const ToolConfig& tool : parameters_.scene.tools) {
    if (tool.name == name) return true;
  }
  return false;
}

// Throws InputError.
std::size_t TissueServices::toolIndex(const std::string& name) const {
  if (!isTool(name)) {
    throw InputError("tool: " + inQuotes(name) +
                     " is no tool; allowed: " + listed(parameters_.scene.tools));
  }
  for (std::size_t tool = 0; tool < pipeline_.tools().size(); ++tool) {
    if (pipeline_.tools()[tool].name == name) return tool;
  }
  throw InputError("tool: " + inQuotes(name) + " is not there yet; allowed: when the parameter '" +
                   parameters_.robot_description_param + "' is set");
}

// A request without a box is meant for a tool: a patch of the nodes at the frame's origin alone is
// hardly ever.
void TissueServices::requireBox(const ApplyLoad::Request& request) const {
  if (!toVec3(request.min).isZero(0.0) || !toVec3(request.max).isZero(0.0)) return;
  throw InputError("name: " + inQuotes(request.name) +
                   " is no tool, and min and max give no box; allowed: a tool (" +
                   listed(parameters_.scene.tools) + "), or a box for a patch of that name");
}

bool TissueServices::onGrasp(Tool::Request& request, Tool::Response& response) {
  try {
    const std::size_t tool = toolIndex(request.tool);
    pipeline_.grasp(tool);
    if (node_.has_pose()) node_.follow();
    const ToolReport& report = pipeline_.report().tools[tool];
    response.success = report.grasps;
    response.message = report.grasps ? std::to_string(report.nodes.size()) + " nodes are held"
                                     : "tool " + inQuotes(request.tool) + ": holds nothing: " +
                                           (report.holds_nothing.empty() ? "its jaws opened since"
                                                                         : report.holds_nothing);
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

bool TissueServices::onRelease(Tool::Request& request, Tool::Response& response) {
  try {
    const std::size_t tool = toolIndex(request.tool);
    if (!pipeline_.report().tools[tool].grasps) {
      throw InputError("tool: " + inQuotes(request.tool) +
                       " holds nothing; allowed: a grasper that holds tissue");
    }
    pipeline_.letGo(tool);
    if (node_.has_pose()) node_.follow();
    response.success = true;
    response.message = "let go";
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

// A force drives the tool, or drives it no longer.
void TissueServices::pushTool(const ApplyLoad::Request& request, ApplyLoad::Response& response) {
  const std::size_t tool = toolIndex(request.name);
  if (!request.displacement.empty() || request.turns || request.force.size() > 1) {
    throw InputError(std::string(!request.displacement.empty() ? "displacement"
                                 : request.turns               ? "turns"
                                                               : "force") +
                     ": given for tool " + inQuotes(request.name) +
                     "; allowed: one force, or none to put the tool at its pose again");
  }
  std::optional<Vec3> force;
  if (!request.force.empty()) {
    force = toVec3(request.force.front());
    requireWithin(*force, kGreatestForce, "N", "tool " + inQuotes(request.name) + ": force");
  }
  pipeline_.push(tool, force);
  if (!node_.has_pose()) {
    response.message = "from the next good pose on";
    return;
  }
  response.message = followPush(tool, force.has_value());
  response.force = toVector3(forceOnTissue(pipeline_, tool));
  response.displacement = toVector3(pipeline_.report().tools[tool].offset);
}

// Until the tool stands, or the time of an update is over. Returns what became of it.
std::string TissueServices::followPush(std::size_t tool, bool is_pushed) {
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(updateBudget(parameters_));
  do {
    node_.follow();
  } while (pipeline_.report().changed && ros::SteadyTime::now() < end);
  const ToolReport& report = pipeline_.report().tools[tool];
  if (pipeline_.report().changed) return "on its way";
  if (!is_pushed) return "at its pose";
  if (report.unanswered) {
    return "pushed; " + std::string(toString(SolveStatus::kUnconverged)) +
           ", nothing answers with the force on the tool's way of " +
           numberText(report.offset.norm()) + " m";
  }
  return report.saturated ? "pushed; the force told is limited by the tool's max_force" : "pushed";
}

}  // namespace robot_tissue
