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
ContactSet OverlapResolver::overlapOf(const Links& links, const RobotPose& pose) const {
  RobotPose alone = world_.tools.complete({});
  const auto is_one = [&](std::size_t link) { return link >= links.first && link < links.end; };
  for (std::size_t link = links.first; link < links.end; ++link) {
    alone.links[link] = pose.links[link];
  }
  ContactSet overlap =
      world_.finder.find(alone, world_.tissue.surface(), world_.tissue.vertices(), 0.0);
  auto& all = overlap.contacts;
  const auto is_others = [&](const Contact& contact) { return !is_one(at(contact.link)); };
  all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
  return overlap;
}

// Of the first link whose middle is beneath the surface: that middle.
std::optional<Vec3> OverlapResolver::middleBeneath(const Links& links,
                                                   const RobotPose& pose) const {
  for (std::size_t link = links.first; link < links.end; ++link) {
    if (ToolSet::isAway(pose.links[link]) || world_.finder.reach(link) <= 0.0) continue;
    const Vec3 middle = pose.links[link] * world_.finder.center(link);
    if (encloses(world_.tissue.vertices(), world_.tissue.surface().triangles, middle)) {
      return middle;
    }
  }
  return std::nullopt;
}

bool OverlapResolver::isInTissue(const Links& links, const RobotPose& pose) const {
  return depthIn(links, pose).has_value();
}

// Of the deepest point of the surface in the links (m); absent: they are not in the tissue.
std::optional<double> OverlapResolver::depthIn(const Links& links, const RobotPose& pose) const {
  const double touches = tuning::kOverlapRounding * world_.tissue.lattice().spacing();
  const double depth = deepest(overlapOf(links, pose));
  if (depth > touches || middleBeneath(links, pose)) return depth;
  return std::nullopt;
}

bool OverlapResolver::isInTissue(std::size_t tool, const RobotPose& pose) const {
  return isInTissue(Links{world_.tools.firstLink(tool), world_.tools.endLink(tool)}, pose);
}

// Unit directions out of the tissue that may be short: as the surface looks where the links go
// through it, against the contacts' normals, from their middle to the nearest vertex of the
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
  if (const auto middle = middleBeneath(links, pose)) {
    Vec3 nearest = vertices.front();
    for (const Vec3& vertex : vertices) {
      if ((vertex - *middle).norm() < (nearest - *middle).norm()) nearest = vertex;
    }
    addUnit(nearest - *middle, ways);
  }
  for (int axis = 0; axis < 3; ++axis) {
    ways.push_back(Vec3::Unit(axis));
    ways.push_back(-Vec3::Unit(axis));
  }
  return ways;
}

// Steps of one spacing along a way until the links are out; nothing when these are not fewer than
// `most`, or the last of the tissue on the way is one that gives no way back in.
std::optional<int> OverlapResolver::stepsOut(const Links& links, const RobotPose& pose,
                                             const Vec3& way, int most) const {
  const std::vector<std::uint8_t> held = world_.sticking.heldNodes(world_.tissue);
  bool gives_way = false;
  for (int steps = 0, next = 1; steps < most; steps += next) {
    const RobotPose there = moved(links, steps * world_.tissue.lattice().spacing() * way, pose);
    const ContactSet overlap = overlapOf(links, there);
    const double depth = deepest(overlap);
    next = stepsWithin(depth, world_.tissue.lattice().spacing());
    if (depth <= 0.0 && !middleBeneath(links, there)) {
      return gives_way ? std::optional<int>(steps) : std::nullopt;
    }
    if (!overlap.contacts.empty()) gives_way = false;
    for (const Contact& contact : overlap.contacts) {
      gives_way = gives_way || SlidingContacts::givesWay(contact.place, world_.tissue, held);
    }
  }
  return std::nullopt;
}

// Step by step, by the shortest way. True: they were in the tissue.
bool OverlapResolver::resolveOverlap(const Links& links, RobotPose& pose) const {
  if (!isInTissue(links, pose)) return false;
  const std::vector<Vec3> ways = waysOut(links, pose);
  Vec3 shortest = ways.front();
  int fewest = Pipeline::kMostLoadSteps / 5;
  for (const Vec3& way : ways) {
    if (const auto steps = stepsOut(links, pose, way, fewest)) {
      shortest = way;
      fewest = *steps;
      if (world_.deadline.isOver()) break;
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
// around what is between them.
bool OverlapResolver::resolveOverlap(std::size_t tool, RobotPose& pose) const {
  const std::size_t first = world_.tools.firstLink(tool), end = world_.tools.endLink(tool);
  bool was_inside = false;
  if (world_.tools[tool].role.has_jaws) {
    for (std::size_t link = first; link < end; ++link) {
      was_inside = resolveOverlap(Links{link, link + 1}, pose) || was_inside;
    }
  } else {
    was_inside = resolveOverlap(Links{first, end}, pose);
  }
  return was_inside;
}

}  // namespace robot_tissue
