// Pipeline: tools that grasp, and tools that a force drives.
#include <algorithm>
#include <cmath>

#include "robot_tissue/pipeline/pipeline.h"
#include "tool_list.h"

namespace robot_tissue {
namespace {

constexpr double kOpposed = -0.5;    // cosine between the ways out of two jaws
constexpr int kMostPushes = 12;      // corrections of a driven tool in one update
constexpr double kPushed = 0.005;    // of the force: near enough
constexpr double kFirstPush = 0.1;   // of a load step: to learn the stiffness from
constexpr double kFarthest = 200.0;  // load steps: a driven tool that finds nothing to push stops

}  // namespace

// Between the jaws of a grasper (m); nothing where it stands nowhere, or a jaw has no shapes.
std::optional<double> Pipeline::jawGap(std::size_t tool, const RobotPose& pose) const {
  if (tools_[tool].role != ToolConfig::Role::kGrasper) return std::nullopt;
  const std::size_t jaw = first_link_[tool + 1] - 2;
  const bool bare = finder_.reach(jaw) <= 0.0 || finder_.reach(jaw + 1) <= 0.0;
  if (bare || isAway(pose.links[jaw])) return std::nullopt;
  return finder_.gap(jaw, jaw + 1, pose);
}

// Before a load step: jaws that opened let go.
void Pipeline::openJaws() {
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const auto gap = jawGap(tool, pose_);
    if (!gap || !closed_[tool] || *gap <= tools_[tool].grasp.open_gap) continue;
    closed_[tool] = false;
    letGo(tool);
  }
}

// After it: jaws that closed hold what they have pressed aside as it is now, not within them.
void Pipeline::closeJaws() {
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const auto gap = jawGap(tool, pose_);
    if (!gap || closed_[tool] || *gap >= tools_[tool].grasp.close_gap) continue;
    closed_[tool] = true;
    hold(tool);
  }
}

// What is between the jaws sticks to the nearer one, in place of what they have pushed. Returns how
// many nodes.
std::size_t Pipeline::hold(std::size_t tool) {
  const std::size_t first = first_link_[tool + 1] - 2;
  const std::vector<int> of_first = nodesBetweenJaws(tool, first);
  const std::vector<int> of_second = nodesBetweenJaws(tool, first + 1);
  if (of_first.empty() && of_second.empty()) return 0;
  patches_.letGo(static_cast<int>(tool));
  contacts_.clear(static_cast<int>(tool));
  for (std::size_t jaw = first; jaw < first + 2; ++jaw) {
    patches_.hold(static_cast<int>(tool), static_cast<int>(jaw), pose_.links[jaw],
                  jaw == first ? of_first : of_second, tissue_);
  }
  return of_first.size() + of_second.size();
}

// Nodes that the ways out of the two jaws lead to from opposite sides, with no more tissue on
// either side than the jaws are apart; and nodes under touches, or pushed. Those nearest to this
// jaw.
std::vector<int> Pipeline::nodesBetweenJaws(std::size_t tool, std::size_t jaw) const {
  const std::size_t first = first_link_[tool + 1] - 2;
  const std::size_t other = jaw == first ? first + 1 : first;
  const double spacing = tissue_.lattice().spacing();
  const double reach = finder_.gap(first, first + 1, pose_) + spacing;
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(tissue_.state().displacement.size()); ++node) {
    const Vec3 position = tissue_.nodePosition(node);
    const auto here = finder_.wayOut(jaw, pose_.links[jaw], position, reach);
    if (!here) continue;
    const auto there = finder_.wayOut(other, pose_.links[other], position, reach);
    if (!there || here->normal.dot(there->normal) > kOpposed) continue;
    const double between = -(here->depth_m + there->depth_m);
    const bool nearer =
        here->depth_m > there->depth_m || (here->depth_m == there->depth_m && jaw == first);
    if (nearer && between <= reach) nodes.push_back(node);
  }
  for (const ToolContacts::Touch& touch : contacts_.touches()) {
    if (touch.link != static_cast<int>(jaw)) continue;
    if (touch.spring.multiplier <= 0.0) continue;
    for (const NodeWeight& carrier : touch.spring.carriers) nodes.push_back(carrier.node);
  }
  for (const auto& [node, seat] : patches_.seats()[tool]) {
    if (seat.link == static_cast<int>(jaw)) nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// A grasper that is pulled harder than it holds loses what it held.
void Pipeline::tearOff() {
  bool torn = false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const double most = tools_[tool].grasp.max_force;
    if (tools_[tool].role != ToolConfig::Role::kGrasper || most <= 0.0) continue;
    if (!patches_.holds(static_cast<int>(tool)) || answerOf(tool).force.norm() <= most) continue;
    patches_.letGo(static_cast<int>(tool));
    torn = true;
    addOnce(tool, report_.torn_off);
  }
  if (!torn) return;
  patches_.ride(pose_, tissue_);
  tissue_.follow(patchesOfTools(), patches_.left(), !supports_.empty());
  contacts_.commit(pose_, tissue_);
}

void Pipeline::grasp(std::size_t tool) {
  const std::string name = "tool '" + names_[tool] + "'";
  if (tools_[tool].role != ToolConfig::Role::kGrasper) {
    throw InputError(name + ": its role is push; allowed: a tool with the role grasper");
  }
  if (!last_pose_) throw InputError(name + ": has no pose yet; allowed: a tool that stands");
  if (hold(tool) == 0) {
    throw InputError(name + ": nothing is between its jaws; allowed: jaws around tissue");
  }
  // Jaws that stand open all the same need not open to let go, but be told.
  const std::size_t jaw = first_link_[tool + 1] - 2;
  closed_[tool] = finder_.gap(jaw, jaw + 1, pose_) <= tools_[tool].grasp.open_gap;
  touched_ = true;
}

void Pipeline::letGo(std::size_t tool) {
  if (patches_.holds(static_cast<int>(tool))) touched_ = true;
  patches_.letGo(static_cast<int>(tool));
}

void Pipeline::push(std::size_t tool, const std::optional<Vec3>& force) {
  if (force && !(force->norm() > 0.0 && force->allFinite())) {
    throw InputError("tool '" + names_[tool] +
                     "': the force is zero or not finite; allowed: a force");
  }
  const bool same_way = force && drives_[tool].force &&
                        force->normalized().dot(drives_[tool].force->normalized()) > 1.0 - 1e-9;
  if (!same_way) drives_[tool].way = 0.0;
  drives_[tool].force = force;
  touched_ = true;
}

// Where the tools are with what their forces moved them.
RobotPose Pipeline::driven(const RobotPose& pose) const {
  RobotPose driven = complete(pose);
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const Drive& drive = drives_[tool];
    if (!drive.force) continue;
    for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
      driven.links[link].translation() += drive.way * drive.force->normalized();
    }
  }
  return driven;
}

// Moves each driven tool until its force is met: load steps until it touches, then by the secant
// through the last two. True: there is a way left to go.
bool Pipeline::drive(const RobotPose& pose) {
  bool goes_on = false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    Drive& drive = drives_[tool];
    if (!drive.force) continue;
    const Vec3 direction = drive.force->normalized();
    const double wanted = drive.force->norm(), longest = stepOf(first_link_[tool]);
    double met = answerOf(tool).force.dot(direction), stiffness = 0.0;
    int pushes = 0;
    while (std::abs(met - wanted) > kPushed * wanted && pushes++ < kMostPushes) {
      double way = stiffness > 0.0 ? (wanted - met) / stiffness
                                   : (met > 0.0 ? kFirstPush * longest : longest);
      if (met > wanted && stiffness <= 0.0) way = -way;
      way = std::min(std::max(way, -longest), longest);
      if (drive.way + way > kFarthest * longest) break;
      drive.way += way;
      last_pose_ = walk(driven(pose));
      const double now = answerOf(tool).force.dot(direction);
      if (met > 0.0 && now > 0.0 && (now - met) / way > 0.0) stiffness = (now - met) / way;
      met = now;
      if (report_.too_fast || report_.lost || isOutOfTime()) break;
    }
    const bool met_it = std::abs(met - wanted) <= kPushed * wanted || report_.lost;
    goes_on = goes_on || (!met_it && drive.way < (kFarthest - 1.0) * longest);
  }
  return goes_on;
}

}  // namespace robot_tissue
