#include "overlap_resolver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

void addUnit(const Vec3& way, std::vector<Vec3>& ways) {
  if (way.norm() > 0.0) ways.push_back(way.normalized());
}

// Steps on any way, at least one, that do not bring a point out that is so deep (m).
int stepsWithin(double depth, double length) {
  return static_cast<int>(std::clamp(depth / length, 1.0, 1.0 * Pipeline::kMostLoadSteps));
}

}  // namespace

RobotPose OverlapResolver::moved(const Links& links, const Vec3& way, RobotPose pose) {
  for (std::size_t link = links.first; link < links.end; ++link) {
    pose.links[link].translation() += way;
  }
  return pose;
}

// Of these links alone, without their gaps. Supports always stand in the pose.
ContactSet OverlapResolver::overlapOf(const Links& links, const RobotPose& pose,
                                      const std::vector<Vec3>& vertices) const {
  RobotPose alone = world_.tools.complete({});
  const auto is_one = [&](std::size_t link) { return link >= links.first && link < links.end; };
  for (std::size_t link = links.first; link < links.end; ++link) {
    alone.links[link] = pose.links[link];
  }
  ContactSet overlap = world_.finder.find(alone, world_.tissue.surface(), vertices, 0.0);
  auto& all = overlap.contacts;
  const auto is_others = [&](const Contact& contact) { return !is_one(at(contact.link)); };
  all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
  return overlap;
}

ContactSet OverlapResolver::overlapOf(const Links& links, const RobotPose& pose) const {
  return overlapOf(links, pose, world_.tissue.vertices());
}

// A point in a shape of the links that is beneath the surface. Not any point of a link: tissue may
// be between its shapes, as in a fork, or in a ring.
std::optional<Vec3> OverlapResolver::pointBeneath(const Links& links, const RobotPose& pose,
                                                  const std::vector<Vec3>& vertices) const {
  for (std::size_t link = links.first; link < links.end; ++link) {
    if (ToolSet::isAway(pose.links[link])) continue;
    for (const Vec3& inner : world_.finder.innerPoints(link)) {
      const Vec3 point = pose.links[link] * inner;
      if (world_.finder.isInside(point, world_.tissue.surface(), vertices)) return point;
    }
  }
  return std::nullopt;
}

std::optional<Vec3> OverlapResolver::pointBeneath(const Links& links, const RobotPose& pose) const {
  return pointBeneath(links, pose, world_.tissue.vertices());
}

bool OverlapResolver::isInTissue(const Links& links, const RobotPose& pose) const {
  return depthIn(links, pose).has_value();
}

// Of the deepest point of the surface in the links (m); absent: they are not in the tissue.
std::optional<double> OverlapResolver::depthIn(const Links& links, const RobotPose& pose) const {
  const double touches = tuning::kOverlapRounding * world_.tissue.lattice().spacing();
  const double depth = deepest(overlapOf(links, pose));
  if (depth > touches || pointBeneath(links, pose)) return depth;
  return std::nullopt;
}

bool OverlapResolver::isInTissue(std::size_t tool, const RobotPose& pose) const {
  return isInTissue(Links{world_.tools.firstLink(tool), world_.tools.endLink(tool)}, pose);
}

bool OverlapResolver::isClear(std::size_t tool, const RobotPose& pose) const {
  if (isInTissue(tool, pose)) return false;
  const std::vector<Vec3> none(world_.tissue.state().displacement.size(), Vec3::Zero());
  std::vector<Vec3> at_rest;
  deform(world_.tissue.surface(), none, at_rest);
  const Links links{world_.tools.firstLink(tool), world_.tools.endLink(tool)};
  return deepest(overlapOf(links, pose, at_rest)) <= 0.0 && !pointBeneath(links, pose, at_rest);
}

// Unit directions out of the tissue that may be short: as the surface looks where the links go
// through it, against the contacts' normals, from a point in them to the nearest vertex of the
// surface, and along the axes.
std::vector<Vec3> OverlapResolver::waysOut(const Links& links, const RobotPose& pose) const {
  const std::vector<Vec3>& vertices = world_.tissue.vertices();
  Vec3 as_surface = Vec3::Zero(), against_tool = Vec3::Zero();
  for (const Contact& contact : overlapOf(links, pose).contacts) {
    const MeshTriangle& corners = world_.tissue.surface().triangles[at(contact.place.triangle)];
    as_surface += contact.depth_m * doubleArea(vertices, corners);
    against_tool -= contact.depth_m * contact.normal;
  }
  std::vector<Vec3> ways;
  addUnit(as_surface, ways);
  addUnit(against_tool, ways);
  if (const auto point = pointBeneath(links, pose)) {
    Vec3 nearest = vertices.front();
    for (const Vec3& vertex : vertices) {
      if ((vertex - *point).norm() < (nearest - *point).norm()) nearest = vertex;
    }
    addUnit(nearest - *point, ways);
  }
  for (int axis = 0; axis < 3; ++axis) {
    ways.push_back(Vec3::Unit(axis));
    ways.push_back(-Vec3::Unit(axis));
  }
  return ways;
}

bool OverlapResolver::isOut(const Links& links, const RobotPose& pose) const {
  return deepest(overlapOf(links, pose)) <= 0.0 && !pointBeneath(links, pose);
}

// Whether any of the surface in the links does; absent: there is none.
std::optional<bool> OverlapResolver::givesWay(const ContactSet& overlap) const {
  if (overlap.contacts.empty()) return std::nullopt;
  const std::vector<std::uint8_t> held = world_.sticking.heldNodes(world_.tissue);
  return std::any_of(overlap.contacts.begin(), overlap.contacts.end(), [&](const Contact& contact) {
    return SlidingContacts::givesWay(contact, world_.tissue, held);
  });
}

// Of links all beneath the surface that are out after the step, as small ones are: whether what
// they go through in between gives way back in. What meets nothing needs none.
bool OverlapResolver::leavesByWhatGivesWay(const Links& links, const RobotPose& pose,
                                           const Vec3& step) const {
  double beneath = 0.0, out = 1.0;
  for (int halvings = 0; halvings < tuning::kMostHalvings; ++halvings) {
    const double half = 0.5 * (beneath + out);
    const RobotPose there = moved(links, half * step, pose);
    if (const auto gives_way = givesWay(overlapOf(links, there))) return *gives_way;
    (pointBeneath(links, there) ? beneath : out) = half;
  }
  return true;
}

// Steps of one spacing along a way until the links are out; nothing when these are not fewer than
// `most`, or the last of the tissue on the way is one that gives no way back in.
std::optional<int> OverlapResolver::stepsOut(const Links& links, const RobotPose& pose,
                                             const Vec3& way, int most) const {
  const double length = world_.tissue.lattice().spacing();
  RobotPose before = pose;
  std::optional<bool> gives_way = true;
  for (int steps = 0, next = 1; steps < most; steps += next) {
    const RobotPose there = moved(links, steps * length * way, pose);
    if (isOut(links, there)) {
      const bool comes_back =
          gives_way ? *gives_way : leavesByWhatGivesWay(links, before, next * length * way);
      return comes_back ? std::optional<int>(steps) : std::nullopt;
    }
    const ContactSet overlap = overlapOf(links, there);
    next = stepsWithin(deepest(overlap), length);
    gives_way = givesWay(overlap);
    before = there;
  }
  return std::nullopt;
}

// Step by step, by the shortest way. True: they were in the tissue.
bool OverlapResolver::resolveOverlap(const Links& links, RobotPose& pose) const {
  if (!isInTissue(links, pose)) return false;
  const std::vector<Vec3> ways = waysOut(links, pose);
  Vec3 shortest = ways.front();
  int fewest = Pipeline::kMostLoadSteps / 5;
  bool is_found = false;
  for (const Vec3& way : ways) {
    if (is_found && world_.deadline.isOver()) break;
    if (const auto steps = stepsOut(links, pose, way, fewest)) {
      shortest = way;
      fewest = *steps;
      is_found = true;
    }
  }
  const double length = world_.tissue.stepLength();
  for (int left = Pipeline::kMostLoadSteps; left > 0;) {
    const std::optional<double> depth = depthIn(links, pose);
    if (!depth) break;
    int steps = std::min(left, stepsWithin(*depth, length));
    left -= steps;
    while (steps-- > 0) pose = moved(links, length * shortest, std::move(pose));
  }
  return true;
}

// A tool that is in the tissue; the jaws of a grasper each for itself, so that they come back
// around what is between them, unless nothing can be.
bool OverlapResolver::resolveOverlap(std::size_t tool, JawsStand jaws, RobotPose& pose) const {
  const std::size_t first = world_.tools.firstLink(tool), end = world_.tools.endLink(tool);
  bool was_inside = false;
  if (world_.tools[tool].role.has_jaws && jaws == JawsStand::kApart) {
    for (std::size_t link = first; link < end; ++link) {
      was_inside = resolveOverlap(Links{link, link + 1}, pose) || was_inside;
    }
  } else {
    was_inside = resolveOverlap(Links{first, end}, pose);
  }
  return was_inside;
}

}  // namespace robot_tissue
