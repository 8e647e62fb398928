#include "grasping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "robot_tissue/core/same_bits.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

// Of the ways out of two jaws (unit).
bool areOpposed(const Vec3& one, const Vec3& other) { return one.dot(other) <= tuning::kOpposed; }

// By the ways out of a node's own jaw and of the other one.
double shareOfOther(const WayOut& here, const WayOut& there) {
  const double to_here = std::max(0.0, -here.depth_m), to_there = -there.depth_m;
  return to_there > 0.0 ? to_here / (to_here + to_there) : 0.0;
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
               areOpposed(one->normal, other->normal), one->depth_m + other->depth_m > 0.0};
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

std::size_t Grasping::otherJaw(std::size_t tool, std::size_t jaw) const {
  const std::size_t first = world_.tools.firstJaw(tool);
  return jaw == first ? first + 1 : first;
}

bool Grasping::grasps(std::size_t tool) const {
  const auto& seats = world_.sticking.attachments()[tool];
  return world_.tools[tool].role.holds &&
         std::any_of(seats.begin(), seats.end(), [](const auto& s) { return s.second.grasped; });
}

// Forgets how the jaws of a tool stood that comes in anew; that it was told to let go stays, and
// that the tissue is new to it.
void Grasping::forgetJaws(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  if (jaws.let_go) return;
  jaws.state = Jaws::State::kUnseen;
  jaws.loss = Jaws::Loss::kClosedBefore;
}

void Grasping::meetNewTissue() {
  setTools(jaws_.size());
  for (Jaws& jaws : jaws_) jaws.stood_before = true;
}

void Grasping::comeBackAround(std::size_t tool, const RobotPose& pose) {
  if (!hasJaws(tool, pose) || jaws_[tool].stood_before) return;
  const auto pinch = narrowestPinch(tool, pose);
  const bool is_open = pinch && pinch->gap >= world_.tools[tool].grasp.close_gap;
  if (is_open) jaws_[tool].state = Jaws::State::kOpen;
}

bool Grasping::areShut(std::size_t tool, const RobotPose& pose) const {
  if (!hasJaws(tool, pose)) return false;
  const auto pinch = narrowestPinch(tool, pose);
  const double least = tuning::kShut * world_.tissue.lattice().spacing();
  return pinch && (pinch->overlaps || pinch->gap < least);
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
    const double stands = jaws.stood_before ? std::min(*gap, gapAsAsked(tool, *gap)) : *gap;
    jaws.state = stands < grasp.close_gap ? Jaws::State::kClosed : Jaws::State::kOpen;
    jaws.loss = Jaws::Loss::kClosedBefore;
    jaws.stood_before = false;
  } else if (jaws.state == Jaws::State::kClosed) {
    if (std::min(*gap, gapAsAsked(tool, *gap)) > grasp.open_gap) jaws.state = Jaws::State::kOpen;
  } else if (*gap < grasp.close_gap && hold(tool) > 0) {
    jaws.state = Jaws::State::kClosed;
  }
}

// Where the robot has the jaws, seen from the middle of where they are narrowest (m): they do not
// open by themselves as they come in from outside, each on its way.
double Grasping::gapAsAsked(std::size_t tool, double otherwise) const {
  const auto here = narrowestPinch(tool, world_.pose);
  if (!here || !hasJaws(tool, world_.asked)) return otherwise;
  const auto asked = pinchAt(tool, world_.asked, here->middle);
  return asked ? asked->gap : otherwise;
}

// What is between the jaws sticks to the nearer one, and by its place between them to the other, in
// place of what they have pushed. Returns how many nodes.
std::size_t Grasping::hold(std::size_t tool) {
  const std::size_t jaw = world_.tools.firstJaw(tool);
  const auto pinch = narrowestPinch(tool, world_.pose);
  if (!pinch) return 0;
  std::vector<StickingContacts::Grip> grips = gripsOf(tool, jaw, pinch->gap);
  for (const auto& grip : gripsOf(tool, jaw + 1, pinch->gap)) grips.push_back(grip);
  if (grips.empty()) return 0;
  jaws_[tool].grip = {world_.pose.links[jaw].inverse() * pinch->middle,
                      world_.pose.links[jaw + 1].inverse() * pinch->middle};
  world_.sticking.letGo(static_cast<int>(tool));
  world_.sliding.clear(static_cast<int>(tool));
  world_.sticking.hold(static_cast<int>(tool), grips, world_.pose, world_.tissue);
  return grips.size();
}

// What this jaw is to hold of the nodes between both, in their order, without those that are fixed
// or others hold. Were all of a node's place the nearer jaw's, jaws that close on would squeeze the
// middle alone.
std::vector<StickingContacts::Grip> Grasping::gripsOf(std::size_t tool, std::size_t jaw,
                                                      double gap) const {
  const std::vector<std::uint8_t> taken = world_.sticking.takenNodes(world_.tissue);
  const auto& seats = world_.sticking.attachments()[tool];
  std::vector<StickingContacts::Grip> grips;
  for (const auto& [node, share] : nodesBetweenJaws(tool, jaw, gap)) {
    if (isGone(world_.tissue.state(), node)) continue;
    if (taken[at(node)] != 0 && seats.count(node) == 0) continue;
    grips.push_back({node, static_cast<int>(jaw), static_cast<int>(otherJaw(tool, jaw)), share});
  }
  return grips;
}

// Nodes that the ways out of the two jaws lead to from opposite sides, with no more tissue on
// either side than the jaws are apart (m); and nodes under touches, or pushed, between the jaws.
// Those nearest to this jaw, with the share of the other one in their place.
std::map<int, double> Grasping::nodesBetweenJaws(std::size_t tool, std::size_t jaw,
                                                 double gap) const {
  const std::size_t other = otherJaw(tool, jaw);
  const double reach = gap + world_.tissue.lattice().spacing();
  std::map<int, double> shares;
  for (int node = 0; node < static_cast<int>(world_.tissue.state().displacement.size()); ++node) {
    const Vec3 position = world_.tissue.nodePosition(node);
    const auto here = world_.finder.wayOut(jaw, world_.pose.links[jaw], position, reach);
    if (!here) continue;
    const auto there = world_.finder.wayOut(other, world_.pose.links[other], position, reach);
    if (!there || !areOpposed(here->normal, there->normal)) continue;
    const double between = -(here->depth_m + there->depth_m);
    const bool nearer =
        here->depth_m > there->depth_m || (here->depth_m == there->depth_m && jaw < other);
    if (nearer && between <= reach) shares[node] = shareOfOther(*here, *there);
  }
  const auto add = [&](int node) {
    if (shares.count(node) == 0) shares[node] = shareAt(jaw, other, node);
  };
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (at(touch.contact.link) != jaw || !isPinched(touch)) continue;
    for (const NodeWeight& carrier : touch.spring.carriers) {
      if (carrier.weight >= tuning::kGripped) add(carrier.node);
    }
  }
  for (const auto& [node, seat] : world_.sticking.attachments()[tool]) {
    const auto pinch = pinchAt(tool, world_.pose, world_.tissue.nodePosition(node));
    if (at(seat.link) == jaw && pinch && pinch->is_between) add(node);
  }
  return shares;
}

double Grasping::shareAt(std::size_t jaw, std::size_t other, int node) const {
  const Vec3 position = world_.tissue.nodePosition(node);
  const auto here = world_.finder.wayOut(jaw, world_.pose.links[jaw], position, kAnywhere);
  const auto there = world_.finder.wayOut(other, world_.pose.links[other], position, kAnywhere);
  if (!here || !there || !areOpposed(here->normal, there->normal)) return 0.0;
  return shareOfOther(*here, *there);
}

// A jaw pushes what it touches towards the other one.
bool Grasping::pushesWith(std::size_t link) const {
  const auto& touches = world_.sliding.touches();
  return std::any_of(touches.begin(), touches.end(), [&](const auto& touch) {
    return at(touch.contact.link) == link && isPinched(touch);
  });
}

// Whether its jaw pushes that point towards the other one.
bool Grasping::isPinched(const SlidingContacts::ContactConstraint& touch) const {
  if (touch.spring.multiplier <= 0.0) return false;
  const std::size_t other = otherJaw(at(touch.contact.tool), at(touch.contact.link));
  const Vec3 point = pointOf(touch.spring, world_.tissue.state().displacement);
  const auto there = world_.finder.wayOut(other, world_.pose.links[other], point, kAnywhere);
  return there && areOpposed(there->normal, touch.spring.normal);
}

bool Grasping::grasp(std::size_t tool) {
  Jaws& jaws = jaws_[tool];
  if (!hasJaws(tool, world_.pose) || hold(tool) == 0) return false;
  // Jaws that stand open all the same need not open to let go, but be told.
  const auto gap = gapAtTissue(tool, world_.pose);
  const bool closed = gap && *gap <= world_.tools[tool].grasp.open_gap;
  jaws.state = closed ? Jaws::State::kClosed : Jaws::State::kOpen;
  jaws.let_go = false;
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
