#include "grasping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "robot_tissue/core/same_bits.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

std::string inMeters(double length) {
  std::ostringstream text;
  text << " (" << length << " m)";
  return text.str();
}

}  // namespace

// Both stand somewhere and have shapes.
bool Grasping::hasJaws(std::size_t tool, const RobotPose& pose) const {
  if (!world_.tools[tool].role.holds) return false;
  const std::size_t jaw = world_.tools.firstJaw(tool);
  return world_.finder.reach(jaw) > 0.0 && world_.finder.reach(jaw + 1) > 0.0 &&
         !ToolSet::isAway(pose.links[jaw]);
}

// Wherever they are nearest to each other (m), as ContactFinder::gap tells it; nothing without
// jaws.
std::optional<double> Grasping::leastGap(std::size_t tool, const RobotPose& pose,
                                         double reach) const {
  if (!hasJaws(tool, pose)) return std::nullopt;
  const std::size_t jaw = world_.tools.firstJaw(tool);
  const Pose jaw_T_other = pose.links[jaw].inverse() * pose.links[jaw + 1];
  std::optional<Gap>& last = last_gaps_[tool];
  const bool stand_still =
      last && (last->jaw_T_other.matrix() - jaw_T_other.matrix()).norm() <= tuning::kSameOpening;
  if (!stand_still || !last->tells(reach)) {
    last = Gap{jaw_T_other, reach, world_.finder.gap(jaw, jaw + 1, pose, reach)};
  }
  return last->gap;
}

// The jaws' points that are nearest to this one.
std::optional<Grasping::Pinch> Grasping::pinchAt(std::size_t tool, const RobotPose& pose,
                                                 const Vec3& point) const {
  const std::size_t jaw = world_.tools.firstJaw(tool);
  const auto one = world_.finder.wayOut(jaw, pose.links[jaw], point, kAnywhere);
  const auto other = world_.finder.wayOut(jaw + 1, pose.links[jaw + 1], point, kAnywhere);
  if (!one || !other) return std::nullopt;
  const Vec3 on_one = point + one->depth_m * one->normal;
  const Vec3 on_other = point + other->depth_m * other->normal;
  return Pinch{(on_one - on_other).norm(), 0.5 * (on_one + on_other),
               one->normal.dot(other->normal) < 0.0};
}

// Of the surface, in a box around both; and what touches them.
std::vector<Vec3> Grasping::pointsNearJaws(std::size_t tool, const RobotPose& pose) const {
  const std::size_t jaw = world_.tools.firstJaw(tool);
  Box around = world_.finder.bounds(jaw, pose.links[jaw]);
  const Box other = world_.finder.bounds(jaw + 1, pose.links[jaw + 1]);
  around.extend(other);
  const Box tissue = world_.tissue.bounds();
  std::vector<Vec3> points;
  if (!around.intersects(tissue)) return points;
  const auto take = [&](const Vec3& point) {
    if (around.contains(point)) points.push_back(point);
  };
  for (const Vec3& vertex : world_.tissue.vertices()) take(vertex);
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (at(touch.contact.tool) == tool)
      take(pointOf(touch.spring, world_.tissue.state().displacement));
  }
  return points;
}

// The narrowest around a point of the surface that is between the jaws, or touches one.
std::optional<Grasping::Pinch> Grasping::narrowestPinch(std::size_t tool,
                                                        const RobotPose& pose) const {
  const std::size_t jaw = world_.tools.firstJaw(tool);
  std::vector<Vec3> points = pointsNearJaws(tool, pose);
  std::optional<Look>& last = last_looks_[tool];
  if (last && areSame(last->jaws[0], pose.links[jaw]) &&
      areSame(last->jaws[1], pose.links[jaw + 1]) && areSame(last->points, points)) {
    return last->narrowest;
  }
  std::optional<Pinch> narrowest;
  for (const Vec3& point : points) {
    const auto pinch = pinchAt(tool, pose, point);
    if (!pinch || !pinch->is_between) continue;
    if (!narrowest || pinch->gap < narrowest->gap) narrowest = pinch;
  }
  last = Look{{pose.links[jaw], pose.links[jaw + 1]}, std::move(points), narrowest};
  return narrowest;
}

// Of the jaws where they hold (m), or where tissue is between them; nothing where none is.
std::optional<double> Grasping::gapAtTissue(std::size_t tool, const RobotPose& pose) const {
  std::optional<Pinch> pinch;
  if (grasps(tool)) {
    const std::size_t jaw = world_.tools.firstJaw(tool);
    const auto& grip = jaws_[tool].grip;
    pinch = pinchAt(tool, pose, 0.5 * (pose.links[jaw] * grip[0] + pose.links[jaw + 1] * grip[1]));
  } else {
    pinch = narrowestPinch(tool, pose);
  }
  return pinch ? std::optional<double>(pinch->gap) : std::nullopt;
}

bool Grasping::grasps(std::size_t tool) const {
  const auto& seats = world_.sticking.attachments()[tool];
  return world_.tools[tool].role.holds &&
         std::any_of(seats.begin(), seats.end(), [](const auto& s) { return s.second.grasped; });
}

// Forgets how the jaws of a tool stood that comes in anew; that it was told to let go stays.
void Grasping::forgetJaws(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  if (jaws.let_go) return;
  const bool were_apart = jaws.were_apart;
  jaws = Jaws();
  jaws.were_apart = were_apart;
}

// Before a load step: jaws that opened let go.
void Grasping::openJaws() {
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    Jaws& jaws = jaws_[tool];
    if (jaws.state != Jaws::State::kClosed || !grasps(tool) || !hasJaws(tool, world_.pose)) {
      continue;
    }
    const auto gap = gapAtTissue(tool, world_.pose);
    if (!gap || *gap <= world_.tools[tool].grasp.open_gap) continue;
    jaws.state = Jaws::State::kOpen;
    world_.sticking.letGo(static_cast<int>(tool));
  }
}

// After a load step: jaws that closed hold the tissue as they have pressed it, not as it would be
// inside them.
void Grasping::closeJaws() {
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!hasJaws(tool, world_.pose)) continue;
    Jaws& jaws = jaws_[tool];
    jaws.were_apart = jaws.were_apart || *leastGap(tool, world_.pose, 0.0) > 0.0;
    if (!jaws.let_go) watchJaws(tool);
  }
}

// Jaws that were closed before tissue came between them hold none of it.
void Grasping::watchJaws(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  const GraspConfig& grasp = world_.tools[tool].grasp;
  const auto gap = gapAtTissue(tool, world_.pose);
  const auto& touches = world_.sliding.touches();
  const bool touch = std::any_of(touches.begin(), touches.end(),
                                 [&](const auto& any) { return at(any.contact.tool) == tool; });
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

// What is between the jaws sticks to the nearer one, and by its place between them to the other, in
// place of what they have pushed. Returns how many nodes.
std::size_t Grasping::hold(std::size_t tool) {
  const std::size_t jaw = world_.tools.firstJaw(tool);
  const auto pinch = narrowestPinch(tool, world_.pose);
  const double gap = pinch ? pinch->gap : world_.finder.gap(jaw, jaw + 1, world_.pose);
  const std::vector<int> of_first = nodesBetweenJaws(tool, jaw, gap);
  const std::vector<int> of_second = nodesBetweenJaws(tool, jaw + 1, gap);
  const std::size_t count = of_first.size() + of_second.size();
  if (count == 0) return 0;
  Vec3 middle = Vec3::Zero();
  for (const auto* nodes : {&of_first, &of_second}) {
    for (const int node : *nodes) {
      middle += world_.tissue.nodePosition(node) / static_cast<double>(count);
    }
  }
  if (pinch) middle = pinch->middle;
  jaws_[tool].grip = {world_.pose.links[jaw].inverse() * middle,
                      world_.pose.links[jaw + 1].inverse() * middle};
  world_.sticking.letGo(static_cast<int>(tool));
  world_.sliding.clear(static_cast<int>(tool));
  std::vector<StickingContacts::Grip> grips = gripsOf(of_first, jaw, jaw + 1);
  for (const auto& grip : gripsOf(of_second, jaw + 1, jaw)) grips.push_back(grip);
  world_.sticking.hold(static_cast<int>(tool), grips, world_.pose, world_.tissue);
  return count;
}

// Were all of a node's place the nearer jaw's, jaws that close on would squeeze the middle alone.
std::vector<StickingContacts::Grip> Grasping::gripsOf(const std::vector<int>& nodes,
                                                      std::size_t jaw, std::size_t other) const {
  std::vector<StickingContacts::Grip> grips;
  for (const int node : nodes) {
    StickingContacts::Grip grip{node, static_cast<int>(jaw), static_cast<int>(other), 0.0};
    const Vec3 position = world_.tissue.nodePosition(node);
    const auto here = world_.finder.wayOut(jaw, world_.pose.links[jaw], position, kAnywhere);
    const auto there = world_.finder.wayOut(other, world_.pose.links[other], position, kAnywhere);
    if (here && there && here->normal.dot(there->normal) <= tuning::kOpposed) {
      const double to_here = std::max(0.0, -here->depth_m), to_there = -there->depth_m;
      if (to_there > 0.0) grip.share_of_other = to_here / (to_here + to_there);
    }
    grips.push_back(grip);
  }
  return grips;
}

// Nodes that the ways out of the two jaws lead to from opposite sides, with no more tissue on
// either side than the jaws are apart (m); and nodes under touches, or pushed. Those nearest to
// this jaw, without those that are fixed or others hold.
std::vector<int> Grasping::nodesBetweenJaws(std::size_t tool, std::size_t jaw, double gap) const {
  const std::size_t first = world_.tools.firstJaw(tool);
  const std::size_t other = jaw == first ? first + 1 : first;
  const double reach = gap + world_.tissue.lattice().spacing();
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(world_.tissue.state().displacement.size()); ++node) {
    const Vec3 position = world_.tissue.nodePosition(node);
    const auto here = world_.finder.wayOut(jaw, world_.pose.links[jaw], position, reach);
    if (!here) continue;
    const auto there = world_.finder.wayOut(other, world_.pose.links[other], position, reach);
    if (!there || here->normal.dot(there->normal) > tuning::kOpposed) continue;
    const double between = -(here->depth_m + there->depth_m);
    const bool nearer =
        here->depth_m > there->depth_m || (here->depth_m == there->depth_m && jaw == first);
    if (nearer && between <= reach) nodes.push_back(node);
  }
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (touch.contact.link != static_cast<int>(jaw)) continue;
    if (touch.spring.multiplier <= 0.0) continue;
    for (const NodeWeight& carrier : touch.spring.carriers) nodes.push_back(carrier.node);
  }
  const auto& seats = world_.sticking.attachments()[tool];
  for (const auto& [node, seat] : seats) {
    if (seat.link == static_cast<int>(jaw)) nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const std::vector<std::uint8_t> taken = world_.sticking.takenNodes(world_.tissue);
  const auto is_others = [&](int node) {
    return isGone(world_.tissue.state(), node) || (taken[at(node)] != 0 && seats.count(node) == 0);
  };
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), is_others), nodes.end());
  return nodes;
}

std::string Grasping::whyItHoldsNothing(std::size_t tool, bool is_asked) const {
  if (!world_.last_pose || grasps(tool) || !hasJaws(tool, world_.pose)) return "";
  const Jaws& jaws = jaws_[tool];
  const GraspConfig& grasp = world_.tools[tool].grasp;
  const auto gap = gapAtTissue(tool, world_.pose);
  if (!gap) {
    const bool closed = *leastGap(tool, world_.pose, grasp.close_gap) < grasp.close_gap;
    return closed || is_asked ? "no tissue is between its jaws" : "";
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
  const bool presses =
      pushesWith(world_.tools.firstJaw(tool)) && pushesWith(world_.tools.firstJaw(tool) + 1);
  if (!presses && !is_asked) return "";
  return "where tissue is, its jaws are not closer than grasp.close_gap" +
         inMeters(grasp.close_gap);
}

// A jaw pushes what it touches towards the other one.
bool Grasping::pushesWith(std::size_t link) const {
  const auto& touches = world_.sliding.touches();
  return std::any_of(touches.begin(), touches.end(), [&](const auto& touch) {
    if (at(touch.contact.link) != link || touch.spring.multiplier <= 0.0) return false;
    const std::size_t first = world_.tools.firstJaw(at(touch.contact.tool));
    const std::size_t other = link == first ? first + 1 : first;
    const Vec3 point = pointOf(touch.spring, world_.tissue.state().displacement);
    const auto there = world_.finder.wayOut(other, world_.pose.links[other], point, kAnywhere);
    return there && there->normal.dot(touch.spring.normal) < tuning::kOpposed;
  });
}

bool Grasping::jawsOverlap(std::size_t tool) const {
  if (!world_.last_pose || !jaws_[tool].were_apart) return false;
  const auto gap = leastGap(tool, world_.report.lost ? world_.asked : world_.pose, 0.0);
  return gap && *gap <= 0.0;
}

bool Grasping::grasp(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  if (!hasJaws(tool, world_.pose) || hold(tool) == 0) return false;
  // Jaws that stand open all the same need not open to let go, but be told.
  const auto gap = gapAtTissue(tool, world_.pose);
  const bool closed = gap && *gap <= world_.tools[tool].grasp.open_gap;
  jaws.state = closed ? Jaws::State::kClosed : Jaws::State::kOpen;
  return true;
}

bool Grasping::letGo(std::size_t tool) {
  const bool held = world_.sticking.holds(static_cast<int>(tool));
  if (held) {
    jaws_[tool].let_go = true;
    jaws_[tool].loss = Jaws::Loss::kReleased;
  }
  world_.sticking.letGo(static_cast<int>(tool));
  return held;
}

void Grasping::forgetLetGo() {
  for (Jaws& jaws : jaws_) jaws.let_go = false;
}

// Those that are pulled harder than they hold.
std::vector<std::size_t> Grasping::overpulled() const {
  std::vector<std::size_t> tools;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    const double most = world_.tools[tool].grasp.max_force;
    if (!world_.tools[tool].role.holds || most <= 0.0) continue;
    if (!world_.sticking.holds(static_cast<int>(tool))) continue;
    if (answerOf(world_, tool).force.norm() > most) tools.push_back(tool);
  }
  return tools;
}

void Grasping::endOverpulled() {
  bool any_lost = false;
  for (const std::size_t tool : overpulled()) {
    if (world_.tools[tool].grasp.tears_out && tearOut(tool)) continue;
    lose(tool);
    any_lost = true;
  }
  if (!any_lost) return;
  const Stopwatch watch(world_.report.solve_ms);
  world_.report.changed = true;
  world_.sticking.ride(world_.pose, world_.tissue);
  world_.tissue.follow(patchesOfTools(world_), world_.sticking.left(), beddingOf(world_));
  world_.sliding.commit(world_.pose, world_.tissue);
}

// What it holds is severed from the rest, not on a trial. False: it is nowhere joined to that.
bool Grasping::tearOut(std::size_t tool) {
  if (world_.is_trial) return true;
  const int before = world_.tissue.springsTorn();
  const Stopwatch watch(world_.report.solve_ms);
  if (!world_.tissue.tearOut(world_.sticking.nodes(static_cast<int>(tool)))) return false;
  world_.report.springs_torn += world_.tissue.springsTorn() - before;
  world_.report.changed = true;
  addOnce(tool, world_.report.torn_out);
  world_.sliding.commit(world_.pose, world_.tissue);
  return true;
}

// What it held slips out of its jaws.
void Grasping::lose(std::size_t tool) {
  world_.sticking.letGo(static_cast<int>(tool));
  jaws_[tool].loss = Jaws::Loss::kTorn;
  addOnce(tool, world_.report.torn_off);
}

}  // namespace robot_tissue
