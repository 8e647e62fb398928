#include "tool_reports.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "tuning.h"

namespace robot_tissue {

// A link pushed the node out of itself on the way in; what jaws closed on, it may not have.
Vec3 wayOutOfTool(const World& world, int node, const StickingContacts::Attachment& seat) {
  const Pose& tissue_T_link = world.pose.links[at(seat.link)];
  const Vec3 push = tissue_T_link.linear() * seat.pushed;
  if (!push.isZero(0.0)) return push;
  const auto out =
      world.finder.wayOut(at(seat.link), tissue_T_link, world.tissue.nodePosition(node),
                          std::numeric_limits<double>::infinity());
  return out ? out->normal : Vec3::Zero();
}

namespace {

Vec3 normalOf(const World& world, std::size_t tool) {
  // By link. Of a touch as long as its normal force (N), of a held node as its way out (m): there
  // what counts is the direction.
  std::map<int, std::vector<Vec3>> pushes;
  for (const auto& [node, seat] : world.sticking.attachments()[tool]) {
    pushes[seat.link].push_back(wayOutOfTool(world, node, seat));
  }
  for (const SlidingContacts::ContactConstraint& touch : world.sliding.touches()) {
    const double force = touch.spring.multiplier;
    if (at(touch.contact.tool) == tool && force > 0.0) {
      pushes[touch.contact.link].push_back(force * touch.spring.normal);
    }
  }
  const bool first_only = world.tools[tool].role.has_jaws;
  Vec3 sum = Vec3::Zero(), hardest = Vec3::Zero();
  double all = 0.0;
  for (const auto& [link, of_link] : pushes) {
    for (const Vec3& push : of_link) {
      sum += push;
      all += push.norm();
      if (push.norm() > hardest.norm()) hardest = push;
    }
    if (first_only && all > 0.0) break;
  }
  return (sum.norm() > tuning::kCancelled * all ? sum : hardest).normalized();
}

}  // namespace

std::vector<double> deepestPoints(const World& world, TouchFinder& touch_finder) {
  const RobotPose& pose = world.report.lost ? world.asked : world.pose;
  std::vector<std::size_t> near, tool_of;
  for (std::size_t tool = 0; tool < world.tools.size(); ++tool) {
    for (std::size_t link = world.tools.firstLink(tool); link < world.tools.endLink(tool); ++link) {
      if (world.isInWound(link)) continue;  // it is meant to be where tissue was
      if (!world.finder.bounds(link, pose.links[link]).intersects(world.tissue.bounds())) continue;
      near.push_back(link);
      tool_of.push_back(tool);
    }
  }
  std::vector<double> deepest(world.tools.size(), 0.0);
  if (near.empty()) return deepest;
  const std::vector<double> depths = touch_finder.penetrations(near, pose);
  for (std::size_t i = 0; i < near.size(); ++i) {
    deepest[tool_of[i]] = std::max(deepest[tool_of[i]], depths[i]);
  }
  return deepest;
}

void limitWrench(double max_force, ToolReport& report) {
  const double force = report.force_on_tool.norm();
  if (!(max_force > 0.0) || force <= max_force) return;
  report.saturated = true;
  report.told_share = max_force / force;
  report.torque_on_tool *= report.told_share;
  report.force_on_tool *= report.told_share;
}

// The patch's answer in the tool's frame: its force is on the tissue, its torque about the origin.
ToolReport describeTool(const World& world, const Grasping& grasping, std::size_t tool) {
  ToolReport report;
  const int index = static_cast<int>(tool);
  const Pose& tissue_T_tool = world.pose.links[world.tools.firstLink(tool)];
  report.grasps = grasping.grasps(tool);
  report.jaws_overlap = grasping.jawsOverlap(tool);
  if (world.last_pose && grasping.hasJaws(tool, world.pose)) {
    report.jaw_gap = grasping.gapAtTissue(tool, world.pose);
  }
  report.holds_nothing = grasping.whyItHoldsNothing(tool);
  std::set<int> nodes;
  for (const int node : world.sticking.nodes(index)) {
    report.point += world.tissue.nodePosition(node);
    nodes.insert(node);
    ++report.contacts;
  }
  const std::vector<Vec3>& displacement = world.tissue.state().displacement;
  for (const SlidingContacts::ContactConstraint& touch : world.sliding.touches()) {
    const double force = touch.spring.multiplier;
    if (touch.contact.tool != index || force <= 0.0) continue;
    ++report.contacts;
    report.point += pointOf(touch.spring, displacement);
    for (const NodeWeight& carrier : touch.spring.carriers) nodes.insert(carrier.node);
  }
  if (report.contacts == 0) return report;
  report.nodes.assign(nodes.begin(), nodes.end());
  report.point /= report.contacts;
  report.normal = normalOf(world, tool);
  const PatchAnswer answer = answerOf(world, tool);
  const Vec3 force = -answer.force;
  const Vec3 torque = -answer.torque - tissue_T_tool.translation().cross(force);
  report.force_on_tool = tissue_T_tool.linear().transpose() * force;
  report.torque_on_tool = tissue_T_tool.linear().transpose() * torque;
  return report;
}

}  // namespace robot_tissue
