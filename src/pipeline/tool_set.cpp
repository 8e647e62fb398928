#include "tool_set.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

ToolGeometry asTool(const SupportConfig& support) {
  ToolGeometry tool;
  tool.name = support.name;
  tool.friction = support.friction;
  tool.links.push_back({"", {support.shape}});
  return tool;
}

}  // namespace

void addOnce(std::size_t tool, std::vector<std::size_t>& tools) {
  if (std::find(tools.begin(), tools.end(), tool) == tools.end()) tools.push_back(tool);
}

ToolSet::ToolSet(const std::vector<ToolGeometry>& tools, const std::vector<SupportConfig>& supports)
    : tools_(tools), first_link_({0}) {
  for (const SupportConfig& support : supports) supports_.push_back(asTool(support));
  for (const ToolGeometry& tool : withSupports()) {
    any_rigid_ = any_rigid_ || (tool.role.touches() && tool.patch == ToolConfig::Patch::kRigid);
    names_.push_back(tool.name);
    first_link_.push_back(first_link_.back() + tool.links.size());
  }
}

void ToolSet::setFriction(double friction) {
  for (ToolGeometry& tool : tools_) tool.friction = friction;
}

std::vector<ToolGeometry> ToolSet::withSupports() const {
  std::vector<ToolGeometry> all = tools_;
  all.insert(all.end(), supports_.begin(), supports_.end());
  return all;
}

Pose ToolSet::away() {
  Pose away = Pose::Identity();
  away.translation().setConstant(kFarAway);
  return away;
}

bool ToolSet::isRigid(int tool) const {
  return at(tool) < size() && tools_[at(tool)].patch == ToolConfig::Patch::kRigid;
}

bool ToolSet::isAway(const Pose& pose) { return pose.translation().x() >= kFarAway; }

// With the supports, which stand at the origin of the tissue's frame.
RobotPose ToolSet::complete(const RobotPose& pose) const {
  const std::size_t of_tools = linkCount();
  RobotPose complete = pose;
  if (pose.links.empty()) complete.links.assign(of_tools, away());
  if (complete.links.size() != of_tools) {
    throw InputError("pose: has " + std::to_string(pose.links.size()) +
                     " links; allowed is one for each of the " + std::to_string(of_tools) +
                     " links of the tools");
  }
  for (const Pose& link : complete.links) {
    if (link.matrix().allFinite()) continue;
    throw InputError("pose: a link's transform is not finite; allowed: finite numbers");
  }
  complete.links.resize(allLinks(), Pose::Identity());
  return complete;
}

// The pose `others` with one tool where it is in `pose`.
RobotPose ToolSet::withTool(std::size_t tool, const RobotPose& pose, RobotPose others) const {
  for (std::size_t link = firstLink(tool); link < endLink(tool); ++link) {
    others.links[link] = pose.links[link];
  }
  return others;
}

}  // namespace robot_tissue
