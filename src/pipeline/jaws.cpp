// Pipeline: graspers, and what is between their jaws.
//
// The gap counts where tissue is: seen from a point of the tissue that lies between them, the jaws
// are as far apart as the points of both that are nearest to it. What they share elsewhere, as at a
// hinge, plays no part. What a grasper holds rides on its jaws; then the gap counts there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "robot_tissue/pipeline/pipeline.h"
#include "tool_list.h"

namespace robot_tissue {
namespace {

constexpr double kOpposed = -0.5;  // cosine between the ways out of two jaws
constexpr double kAnywhere = std::numeric_limits<double>::infinity();

std::string inMeters(double length) {
  std::ostringstream text;
  text << " (" << length << " m)";
  return text.str();
}

bool isIn(const Box& box, const Vec3& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

}  // namespace

// Both stand somewhere and have shapes.
bool Pipeline::hasJaws(std::size_t tool, const RobotPose& pose) const {
  if (tools_[tool].role != ToolConfig::Role::kGrasper) return false;
  const std::size_t jaw = firstJaw(tool);
  return finder_.reach(jaw) > 0.0 && finder_.reach(jaw + 1) > 0.0 && !isAway(pose.links[jaw]);
}

// Wherever they are nearest to each other (m); nothing without jaws.
std::optional<double> Pipeline::leastGap(std::size_t tool, const RobotPose& pose) const {
  if (!hasJaws(tool, pose)) return std::nullopt;
  return finder_.gap(firstJaw(tool), firstJaw(tool) + 1, pose);
}

// The jaws' points that are nearest to this one.
std::optional<Pipeline::Pinch> Pipeline::pinchAt(std::size_t tool, const RobotPose& pose,
                                                 const Vec3& point) const {
  const std::size_t jaw = firstJaw(tool);
  const auto one = finder_.wayOut(jaw, pose.links[jaw], point, kAnywhere);
  const auto other = finder_.wayOut(jaw + 1, pose.links[jaw + 1], point, kAnywhere);
  if (!one || !other) return std::nullopt;
  const Vec3 on_one = point + one->depth_m * one->normal;
  const Vec3 on_other = point + other->depth_m * other->normal;
  return Pinch{(on_one - on_other).norm(), 0.5 * (on_one + on_other),
               one->normal.dot(other->normal) < 0.0};
}

// The narrowest around a point of the surface that is between the jaws, or touches one.
std::optional<Pipeline::Pinch> Pipeline::narrowestPinch(std::size_t tool,
                                                        const RobotPose& pose) const {
  const std::size_t jaw = firstJaw(tool);
  Box around = finder_.bounds(jaw, pose.links[jaw]);
  const Box other = finder_.bounds(jaw + 1, pose.links[jaw + 1]);
  around.min = around.min.cwiseMin(other.min);
  around.max = around.max.cwiseMax(other.max);
  const Box tissue = tissue_.bounds();
  std::optional<Pinch> narrowest;
  if ((around.min.array() > tissue.max.array()).any() ||
      (tissue.min.array() > around.max.array()).any()) {
    return narrowest;
  }
  const auto look = [&](const Vec3& point) {
    if (!isIn(around, point)) return;
    const auto pinch = pinchAt(tool, pose, point);
    if (!pinch || !pinch->is_between) return;
    if (!narrowest || pinch->gap < narrowest->gap) narrowest = pinch;
  };
  for (const Vec3& vertex : tissue_.vertices()) look(vertex);
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    if (at(touch.tool) == tool) look(pointOf(touch.spring, tissue_.state().displacement));
  }
  return narrowest;
}

// Of the jaws where they hold (m), or where tissue is between them; nothing where none is.
std::optional<double> Pipeline::gapAtTissue(std::size_t tool, const RobotPose& pose) const {
  std::optional<Pinch> pinch;
  if (grasps(tool)) {
    const std::size_t jaw = firstJaw(tool);
    const auto& grip = jaws_[tool].grip;
    pinch = pinchAt(tool, pose, 0.5 * (pose.links[jaw] * grip[0] + pose.links[jaw + 1] * grip[1]));
  } else {
    pinch = narrowestPinch(tool, pose);
  }
  return pinch ? std::optional<double>(pinch->gap) : std::nullopt;
}

bool Pipeline::grasps(std::size_t tool) const {
  const auto& seats = patches_.attachments()[tool];
  return tools_[tool].role == ToolConfig::Role::kGrasper &&
         std::any_of(seats.begin(), seats.end(), [](const auto& s) { return s.second.grasped; });
}

// Of a tool that lets go to come in anew. What it was told stands.
void Pipeline::forgetJaws(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  if (jaws.let_go) return;
  const bool were_apart = jaws.were_apart;
  jaws = Jaws();
  jaws.were_apart = were_apart;
}

// Before a load step: jaws that opened let go.
void Pipeline::openJaws() {
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    Jaws& jaws = jaws_[tool];
    if (jaws.state != Jaws::State::kClosed || !grasps(tool) || !hasJaws(tool, pose_)) continue;
    const auto gap = gapAtTissue(tool, pose_);
    if (!gap || *gap <= tools_[tool].grasp.open_gap) continue;
    jaws.state = Jaws::State::kOpen;
    patches_.letGo(static_cast<int>(tool));
  }
}

// After it: jaws that closed hold what they have pressed aside as it is now, not within them.
void Pipeline::closeJaws() {
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (!hasJaws(tool, pose_)) continue;
    Jaws& jaws = jaws_[tool];
    jaws.were_apart = jaws.were_apart || *leastGap(tool, pose_) > 0.0;
    if (!jaws.let_go) watchJaws(tool);
  }
}

// Jaws that were closed before tissue came between them hold none of it.
void Pipeline::watchJaws(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  const GraspConfig& grasp = tools_[tool].grasp;
  const auto gap = gapAtTissue(tool, pose_);
  const auto& touches = contacts_.touches();
  const bool touch = std::any_of(touches.begin(), touches.end(),
                                 [&](const auto& any) { return at(any.tool) == tool; });
  if (!gap) {
    if (!touch) jaws.state = Jaws::State::kUnseen;
  } else if (jaws.state == Jaws::State::kUnseen) {
    jaws.state = *gap < grasp.close_gap ? Jaws::State::kClosed : Jaws::State::kOpen;
    jaws.loss = Jaws::Loss::kClosedBefore;
  } else if (jaws.state == Jaws::State::kClosed) {
    if (*gap > grasp.open_gap) jaws.state = Jaws::State::kOpen;
  } else if (*gap < grasp.close_gap && hold(tool) > 0) {
    jaws.state = Jaws::State::kClosed;
  }
}

// What is between the jaws sticks to the nearer one, in place of what they have pushed. Returns how
// many nodes.
std::size_t Pipeline::hold(std::size_t tool) {
  const std::size_t jaw = firstJaw(tool);
  const auto pinch = narrowestPinch(tool, pose_);
  const double gap = pinch ? pinch->gap : finder_.gap(jaw, jaw + 1, pose_);
  const std::vector<int> of_first = nodesBetweenJaws(tool, jaw, gap);
  const std::vector<int> of_second = nodesBetweenJaws(tool, jaw + 1, gap);
  const std::size_t count = of_first.size() + of_second.size();
  if (count == 0) return 0;
  Vec3 middle = Vec3::Zero();
  for (const auto* nodes : {&of_first, &of_second}) {
    for (const int node : *nodes) middle += tissue_.nodePosition(node) / static_cast<double>(count);
  }
  if (pinch) middle = pinch->middle;
  jaws_[tool].grip = {pose_.links[jaw].inverse() * middle, pose_.links[jaw + 1].inverse() * middle};
  jaws_[tool].asked = false;
  patches_.letGo(static_cast<int>(tool));
  contacts_.clear(static_cast<int>(tool));
  for (const std::size_t link : {jaw, jaw + 1}) {
    patches_.hold(static_cast<int>(tool), static_cast<int>(link), pose_.links[link],
                  link == jaw ? of_first : of_second, tissue_);
  }
  return count;
}

// Nodes that the ways out of the two jaws lead to from opposite sides, with no more tissue on
// either side than the jaws are apart (m); and nodes under touches, or pushed. Those nearest to
// this jaw, without those that are fixed or others hold.
std::vector<int> Pipeline::nodesBetweenJaws(std::size_t tool, std::size_t jaw, double gap) const {
  const std::size_t first = firstJaw(tool);
  const std::size_t other = jaw == first ? first + 1 : first;
  const double reach = gap + tissue_.lattice().spacing();
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
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    if (touch.link != static_cast<int>(jaw)) continue;
    if (touch.spring.multiplier <= 0.0) continue;
    for (const NodeWeight& carrier : touch.spring.carriers) nodes.push_back(carrier.node);
  }
  const auto& seats = patches_.attachments()[tool];
  for (const auto& [node, seat] : seats) {
    if (seat.link == static_cast<int>(jaw)) nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  const auto is_others = [&](int node) { return held[at(node)] != 0 && seats.count(node) == 0; };
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), is_others), nodes.end());
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
    jaws_[tool].loss = Jaws::Loss::kTorn;
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
  Jaws& jaws = jaws_[tool];
  if (!hasJaws(tool, pose_) || hold(tool) == 0) {
    jaws.asked = true;
    describeTools();
    const std::string& why = report_.tools[tool].holds_nothing;
    throw InputError(name + ": holds nothing: " +
                     (why.empty() ? "its jaws stand nowhere or have no shapes" : why) +
                     "; allowed: jaws around tissue");
  }
  // Jaws that stand open all the same need not open to let go, but be told.
  const auto gap = gapAtTissue(tool, pose_);
  const bool closed = gap && *gap <= tools_[tool].grasp.open_gap;
  jaws.state = closed ? Jaws::State::kClosed : Jaws::State::kOpen;
  touched_ = true;
}

void Pipeline::letGo(std::size_t tool) {
  if (patches_.holds(static_cast<int>(tool))) {
    touched_ = true;
    jaws_[tool].let_go = true;
    jaws_[tool].loss = Jaws::Loss::kReleased;
  }
  jaws_[tool].asked = false;
  patches_.letGo(static_cast<int>(tool));
}

// Why a grasper holds nothing whose jaws are closed, or press tissue between them, or that was told
// to grasp; else empty.
std::string Pipeline::whyItHoldsNothing(std::size_t tool) const {
  if (!last_pose_ || grasps(tool) || !hasJaws(tool, pose_)) return "";
  const Jaws& jaws = jaws_[tool];
  const GraspConfig& grasp = tools_[tool].grasp;
  const auto gap = gapAtTissue(tool, pose_);
  if (!gap) {
    const bool closed = *leastGap(tool, pose_) < grasp.close_gap;
    return closed || jaws.asked ? "no tissue is between its jaws" : "";
  }
  const std::string open_first =
      ": its jaws must first open farther than grasp.open_gap" + inMeters(grasp.open_gap);
  if (jaws.state == Jaws::State::kClosed) {
    switch (jaws.loss) {
      case Jaws::Loss::kClosedBefore:
        return "its jaws were closed before tissue came between them" + open_first;
      case Jaws::Loss::kReleased:
        return "it was told to let go" + open_first;
      case Jaws::Loss::kTorn:
        return "it was pulled harder than it holds (grasp.max_force)" + open_first;
    }
  }
  if (*gap < grasp.close_gap) return "what is between its jaws is fixed, or held by others";
  const bool presses = pushesWith(firstJaw(tool)) && pushesWith(firstJaw(tool) + 1);
  if (!presses && !jaws.asked) return "";
  return "where tissue is, its jaws are not closer than grasp.close_gap" +
         inMeters(grasp.close_gap);
}

// A jaw pushes what it touches towards the other one.
bool Pipeline::pushesWith(std::size_t link) const {
  const auto& touches = contacts_.touches();
  return std::any_of(touches.begin(), touches.end(), [&](const auto& touch) {
    if (at(touch.link) != link || touch.spring.multiplier <= 0.0) return false;
    const std::size_t first = firstJaw(at(touch.tool));
    const std::size_t other = link == first ? first + 1 : first;
    const Vec3 point = pointOf(touch.spring, tissue_.state().displacement);
    const auto there = finder_.wayOut(other, pose_.links[other], point, kAnywhere);
    return there && there->normal.dot(touch.spring.normal) < kOpposed;
  });
}

}  // namespace robot_tissue
