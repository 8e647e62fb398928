// Blades: edges that touch before they cut.
#include <algorithm>

#include "blades.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Length of the edge from its first point to that nearest to the point (m); how far that is off.
struct EdgePlace {
  double along = 0.0;
  double off = 0.0;
};

EdgePlace placeOf(const std::vector<Vec3>& edge, const Vec3& point) {
  EdgePlace place{0.0, (point - edge.front()).norm()};
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    const Vec3 along = edge[i + 1] - edge[i];
    const double share = std::clamp((point - edge[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double off = (point - edge[i] - share * along).norm();
    if (off < place.off) place = {before + share * along.norm(), off};
    before += along.norm();
  }
  return place;
}

}  // namespace

void Blades::setPhase(std::size_t tool, EdgePhase phase) {
  const bool may_touch = world_.mayEdgeTouch(tool);
  states_[tool].phase = may_touch ? phase : EdgePhase::kInside;
  const bool is_inside = states_[tool].phase == EdgePhase::kInside;
  world_.setEdge(tool, is_inside ? World::Edge::kInside : World::Edge::kTouches);
}

// Of the bar along the edge (m).
double Blades::depthInTissue(std::size_t tool, const Pose& tissue_T_tool) const {
  const std::size_t link = world_.tools.firstLink(tool);
  if (!world_.edges.bounds(link, tissue_T_tool).intersects(world_.tissue.bounds())) return 0.0;
  RobotPose alone = world_.tools.complete({});
  alone.links[link] = tissue_T_tool;
  return world_.edges.penetrations({link}, alone, world_.tissue.surface(), world_.tissue.vertices())
      .front();
}

void Blades::comeIn(const RobotPose& pose) {
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!world_.mayEdgeTouch(tool)) continue;
    const std::vector<Pose>& stands = states_[tool].strides.stands;
    const std::size_t link = world_.tools.firstLink(tool);
    const Pose& there = pose.links[link];
    const double longest = Pipeline::kMostLoadSteps * world_.tissue.stepLength();
    const bool jumps =
        stands.empty() || longestWay(stands.front(), there, world_.reach(link)) > longest;
    if (!jumps || ToolSet::isAway(there)) continue;
    const bool is_inside = depthInTissue(tool, there) > 0.0;
    setPhase(tool, is_inside ? EdgePhase::kInside : EdgePhase::kOutside);
  }
}

// Whether its edge may touch on its way, or is inside: a point of it is never farther than half of
// its way from the nearer end.
bool Blades::meetsTissue(std::size_t tool, const RobotPose& from, const RobotPose& pose) const {
  const std::size_t link = world_.tools.firstLink(tool);
  const double way = longestWay(from.links[link], pose.links[link], world_.reach(link));
  const double margin = 0.5 * way + tuning::kEdgeRadius * world_.tissue.lattice().spacing();
  const auto is_near = [&](const Pose& tissue_T_tool) {
    const Box box = grownBy(margin, world_.edges.bounds(link, tissue_T_tool));
    if (!box.intersects(world_.tissue.bounds())) return false;
    if (states_[tool].phase == EdgePhase::kInside) return true;
    RobotPose alone = world_.tools.complete({});
    alone.links[link] = tissue_T_tool;
    const ContactSet near =
        world_.edges.find(alone, world_.tissue.surface(), world_.tissue.vertices(), margin);
    return !near.contacts.empty();
  };
  return is_near(from.links[link]) || is_near(pose.links[link]);
}

std::vector<RobotPose> Blades::legs(const RobotPose& from, const RobotPose& pose) {
  std::vector<double> ends;
  const double stride = tuning::kBladeStride * world_.tissue.lattice().spacing();
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    const BladeState& state = states_[tool];
    if (!world_.mayEdgeTouch(tool) || state.strides.stands.empty()) continue;
    const std::size_t link = world_.tools.firstLink(tool);
    const bool meets = !ToolSet::isAway(pose.links[link]) && meetsTissue(tool, from, pose);
    if (state.phase == EdgePhase::kOutside) {
      world_.setEdge(tool, meets ? World::Edge::kTouches : World::Edge::kFar);
    }
    if (!meets) continue;
    const double way = longestWay(state.stands(), pose.links[link], world_.reach(link));
    const double last = way - tuning::kStrideRounding * stride;
    const bool is_inside = state.phase == EdgePhase::kInside;
    double end = lookLength() - state.strides.way;
    if (is_inside) end += (tuning::kLooksInStride - 1 - state.looks) * lookLength();
    for (; end < last; end += is_inside ? stride : lookLength()) ends.push_back(end / way);
  }
  std::sort(ends.begin(), ends.end());
  std::vector<RobotPose> legs;
  for (const double end : ends) legs.push_back(between(from, pose, end));
  legs.push_back(pose);
  return legs;
}

// What touches within the bar along the edge, and a little off it, is the edge's.
Blades::Pressing Blades::pressingOf(std::size_t tool) const {
  const std::vector<Vec3>& edge = world_.tools[tool].blade.edge;
  const std::vector<Pose>& path = states_[tool].path;  // not empty
  const Pose tool_T_tissue = world_.pose.links[world_.tools.firstLink(tool)].inverse();
  const double spacing = world_.tissue.lattice().spacing();
  double from = 0.0, to = 0.0, force = 0.0;
  Pressing pressing;
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (at(touch.contact.tool) != tool || !(touch.spring.multiplier > 0.0)) continue;
    const Vec3 point = pointOf(touch.spring, world_.tissue.state().displacement);
    const EdgePlace place = placeOf(edge, tool_T_tissue * point);
    if (place.off > 2.0 * tuning::kEdgeRadius * spacing) continue;
    from = pressing.any() ? std::min(from, place.along) : place.along;
    to = pressing.any() ? std::max(to, place.along) : place.along;
    pressing.length = std::max(spacing, to - from);
    pressing.force += forceOf(touch.spring, world_.tissue.state().displacement);
    pressing.point += touch.spring.multiplier * point;
    force += touch.spring.multiplier;
    const Vec3 before = path.front() * (tool_T_tissue * point);
    pressing.depth = std::max(pressing.depth, (point - before).dot(touch.spring.normal));
  }
  if (pressing.any()) pressing.point /= force;
  return pressing;
}

// The tool's work on what the edge presses, which moved there.
void Blades::countDentWork(std::size_t tool, const Pose& from) {
  BladeState& state = states_[tool];
  if (state.phase == EdgePhase::kInside) return;
  const Pressing pressing = pressingOf(tool);
  const Pose& there = world_.pose.links[world_.tools.firstLink(tool)];
  const Vec3 way = pressing.point - from * (there.inverse() * pressing.point);
  state.dent_work += 0.5 * (state.dent_force + pressing.force).dot(way);
  state.dent_force = pressing.force;
}

// Some times in a stride, outside.
void Blades::press(std::size_t tool) {
  BladeState& state = states_[tool];
  const double spacing = world_.tissue.lattice().spacing();
  const Pressing pressing = pressingOf(tool);
  if (!pressing.any()) {
    if (state.phase == EdgePhase::kDents && world_.tissue.isLate()) return;  // not found yet
    // It slipped past what it should have touched.
    const bool is_beneath = depthInTissue(tool, state.stands()) > tuning::kEdgeRadius * spacing;
    if (is_beneath) return goIn(tool);
    state.phase = EdgePhase::kOutside;
    state.path = {state.stands()};
    state.dent_work = 0.0;
    return;
  }
  state.phase = EdgePhase::kDents;
  const double resistance = world_.tools[tool].blade.resistance;
  if (pressing.depth >= tuning::kDeepestDent * spacing ||
      pressing.force.norm() >= resistance * pressing.length) {
    goIn(tool);
  }
}

bool Blades::breakIn() {
  bool any = false;
  for (std::size_t tool = 0; tool < states_.size(); ++tool) {
    const BladeState& state = states_[tool];
    if (world_.is_trial || state.phase == EdgePhase::kInside || state.path.empty()) continue;
    if (!pressingOf(tool).any()) continue;
    goIn(tool);
    any = true;
  }
  return any;
}

// The tissue comes back to where it is without the edge, which at the end of the stride cuts what
// it swept since it touched.
void Blades::goIn(std::size_t tool) {
  load_step_.forgetUnderWay();  // in which it touches
  setPhase(tool, EdgePhase::kInside);
  world_.sliding.clear(static_cast<int>(tool));
  world_.dead_end.reset();
  comeBack(tool);
}

void Blades::comeBack(std::size_t tool) {
  const Stopwatch watch(world_.report.solve_ms);
  load_step_.lieDown();
  world_.sliding.commit(world_.pose, world_.tissue);
  world_.report.changed = true;
  states_[tool].is_coming_back = world_.tissue.isLate();
}

// Out of the tissue: the next that it meets it dents again.
void Blades::leave(std::size_t tool) {
  if (!world_.mayEdgeTouch(tool) || depthInTissue(tool, states_[tool].stands()) > 0.0) return;
  setPhase(tool, EdgePhase::kOutside);
}

}  // namespace robot_tissue
