// Pipeline: what the tools met.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "robot_tissue/pipeline/pipeline.h"
#include "stopwatch.h"

namespace robot_tissue {
namespace {

constexpr double kCancelled = 1e-6;  // of the pushes: a sum of them that has no direction

bool boxesMeet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

}  // namespace

void Pipeline::describeTools() {
  const Stopwatch watch(report_.contact_ms);
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) report_.tools[tool] = describe(tool);
}

// The patch's answer in the tool's frame: its force is on the tissue, its torque about the origin.
ToolReport Pipeline::describe(std::size_t tool) const {
  ToolReport report;
  const int index = static_cast<int>(tool);
  const Pose& tissue_T_tool = pose_.links[first_link_[tool]];
  report.grasps = grasps(tool);
  report.offset = drives_[tool].force ? Vec3(drives_[tool].way * drives_[tool].force->normalized())
                                      : Vec3(Vec3::Zero());
  report.jaws_overlap = jawsOverlap(tool);
  if (last_pose_ && hasJaws(tool, pose_)) report.jaw_gap = gapAtTissue(tool, pose_);
  report.holds_nothing = whyItHoldsNothing(tool);
  report.max_penetration = deepestPointOf(tool);
  std::set<int> nodes;
  for (const int node : patches_.nodes(index)) {
    report.point += tissue_.nodePosition(node);
    nodes.insert(node);
    ++report.contacts;
  }
  const std::vector<Vec3>& displacement = tissue_.state().displacement;
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    const double force = touch.spring.multiplier;
    if (touch.tool != index || force <= 0.0) continue;
    ++report.contacts;
    report.point += pointOf(touch.spring, displacement);
    for (const NodeWeight& carrier : touch.spring.carriers) nodes.insert(carrier.node);
  }
  if (report.contacts == 0) return report;
  report.nodes.assign(nodes.begin(), nodes.end());
  report.point /= report.contacts;
  report.normal = normalOf(tool);
  const PatchAnswer answer = answerOf(tool);
  const Vec3 force = -answer.force;
  const Vec3 torque = -answer.torque - tissue_T_tool.translation().cross(force);
  report.force_on_tool = tissue_T_tool.linear().transpose() * force;
  report.torque_on_tool = tissue_T_tool.linear().transpose() * torque;
  const double most = tools_[tool].max_force;
  if (most > 0.0 && force.norm() > most) {
    report.saturated = true;
    report.torque_on_tool *= most / force.norm();
    report.force_on_tool *= most / force.norm();
  }
  return report;
}

Vec3 Pipeline::normalOf(std::size_t tool) const {
  std::map<int, std::vector<Vec3>> pushes;  // by link; as long as they are hard
  for (const auto& [node, seat] : patches_.attachments()[tool]) {
    const Pose& tissue_T_link = pose_.links[at(seat.link)];
    Vec3 push = tissue_T_link.linear() * seat.pushed;
    if (push.isZero(0.0)) {
      const auto out = finder_.wayOut(at(seat.link), tissue_T_link, tissue_.nodePosition(node),
                                      std::numeric_limits<double>::infinity());
      if (out) push = out->normal;
    }
    pushes[seat.link].push_back(push);
  }
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    const double force = touch.spring.multiplier;
    if (at(touch.tool) == tool && force > 0.0) {
      pushes[touch.link].push_back(force * touch.spring.normal);
    }
  }
  const bool first_only = tools_[tool].role == ToolConfig::Role::kGrasper;
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
  return (sum.norm() > kCancelled * all ? sum : hardest).normalized();
}

// Also of a tool that touches nothing that gives way (m).
double Pipeline::deepestPointOf(std::size_t tool) const {
  const RobotPose& pose = report_.lost ? asked_ : pose_;
  double deepest = 0.0;
  for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
    if (!boxesMeet(finder_.bounds(link, pose.links[link]), tissue_.bounds())) continue;
    deepest = std::max(deepest, finder_.penetration(link, pose.links[link], tissue_.surface(),
                                                    tissue_.vertices()));
  }
  return deepest;
}

bool Pipeline::jawsOverlap(std::size_t tool) const {
  if (!last_pose_ || !jaws_[tool].were_apart) return false;
  const auto gap = leastGap(tool, report_.lost ? asked_ : pose_);
  return gap && *gap <= 0.0;
}

// What the tool's, or support's, patch exerts on the tissue; zero when it has none.
PatchAnswer Pipeline::answerOf(std::size_t tool) const {
  const auto& patches = tissue_.patches();
  const auto& answers = tissue_.lastReport().patches;
  for (std::size_t i = tissue_.namedPatches(); i < std::min(patches.size(), answers.size()); ++i) {
    if (patches[i].name == names_[tool]) return answers[i];
  }
  return {};
}

ForceBalance Pipeline::forceBalance() const {
  ForceBalance balance;
  for (std::size_t tool = 0; tool < names_.size(); ++tool) {
    (tool < tools_.size() ? balance.tools : balance.supports) += answerOf(tool).force;
  }
  const auto& answers = tissue_.lastReport().patches;
  for (std::size_t i = 0; i < std::min(tissue_.namedPatches(), answers.size()); ++i) {
    balance.loads += answers[i].force;
  }
  balance.weight = tissue_.weight();
  balance.fixed = tissue_.forceOfFixedNodes();
  return balance;
}

}  // namespace robot_tissue
