// Pipeline: how a tool gets out of the tissue that it appeared inside, or is stuck in.
#include <algorithm>
#include <cmath>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tool_list.h"

namespace robot_tissue {
namespace {

void addUnit(const Vec3& way, std::vector<Vec3>& ways) {
  if (way.norm() > 0.0) ways.push_back(way.normalized());
}

}  // namespace

RobotPose Pipeline::moved(const Links& links, const Vec3& way, RobotPose pose) {
  for (std::size_t link = links.first; link < links.end; ++link) {
    pose.links[link].translation() += way;
  }
  return pose;
}

// Of these links alone, without their gaps. Supports always stand in the pose.
ContactSet Pipeline::overlapOf(const Links& links, const RobotPose& pose) const {
  RobotPose alone = complete({});
  const auto is_one = [&](std::size_t link) { return link >= links.first && link < links.end; };
  for (std::size_t link = links.first; link < links.end; ++link) {
    alone.links[link] = pose.links[link];
  }
  ContactSet overlap = finder_.find(alone, tissue_.surface(), tissue_.vertices(), 0.0);
  auto& all = overlap.contacts;
  const auto is_others = [&](const Contact& contact) { return !is_one(at(contact.link)); };
  all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
  return overlap;
}

// Of the first link whose middle is beneath the surface: that middle.
std::optional<Vec3> Pipeline::middleBeneath(const Links& links, const RobotPose& pose) const {
  for (std::size_t link = links.first; link < links.end; ++link) {
    if (isAway(pose.links[link]) || finder_.reach(link) <= 0.0) continue;
    const Vec3 middle = pose.links[link] * finder_.center(link);
    if (encloses(tissue_.vertices(), tissue_.surface().triangles, middle)) return middle;
  }
  return std::nullopt;
}

bool Pipeline::isInTissue(const Links& links, const RobotPose& pose) const {
  return deepest(overlapOf(links, pose)) > 0.0 || middleBeneath(links, pose).has_value();
}

bool Pipeline::isInTissue(std::size_t tool, const RobotPose& pose) const {
  return isInTissue(Links{first_link_[tool], first_link_[tool + 1]}, pose);
}

// Unit directions out of the tissue that may be short: as the surface looks where the links go
// through it, against the contacts' normals, from their middle to the nearest vertex of the
// surface, and along the axes.
std::vector<Vec3> Pipeline::waysOut(const Links& links, const RobotPose& pose) const {
  const std::vector<Vec3>& vertices = tissue_.vertices();
  Vec3 as_surface = Vec3::Zero(), against_tool = Vec3::Zero();
  for (const Contact& contact : overlapOf(links, pose).contacts) {
    const MeshTriangle& corners = tissue_.surface().triangles[at(contact.triangle)];
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
std::optional<int> Pipeline::stepsOut(const Links& links, const RobotPose& pose, const Vec3& way,
                                      int most) const {
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  bool gives_way = false;
  for (int steps = 0; steps < most; ++steps) {
    const RobotPose there = moved(links, steps * tissue_.lattice().spacing() * way, pose);
    const ContactSet overlap = overlapOf(links, there);
    if (deepest(overlap) <= 0.0 && !middleBeneath(links, there)) {
      return gives_way ? std::optional<int>(steps) : std::nullopt;
    }
    if (!overlap.contacts.empty()) gives_way = false;
    for (const Contact& contact : overlap.contacts) {
      const auto carriers = carriersAt(tissue_.surface(), contact.triangle, contact.barycentric);
      gives_way = gives_way || SlidingContacts::givesWay(carriers, held);
    }
  }
  return std::nullopt;
}

// Step by step, by the shortest way. True: they were in the tissue.
bool Pipeline::resolveOverlap(const Links& links, RobotPose& pose) const {
  if (!isInTissue(links, pose)) return false;
  const std::vector<Vec3> ways = waysOut(links, pose);
  Vec3 shortest = ways.front();
  int fewest = kMostLoadSteps / 5;
  for (const Vec3& way : ways) {
    if (const auto steps = stepsOut(links, pose, way, fewest)) {
      shortest = way;
      fewest = *steps;
      if (isOutOfTime()) break;
    }
  }
  for (int step = 0; step < kMostLoadSteps && isInTissue(links, pose); ++step) {
    pose = moved(links, tissue_.stepLength() * shortest, std::move(pose));
  }
  return true;
}

// A tool that is in the tissue; the jaws of a grasper each for itself, so that they come back
// around what is between them.
void Pipeline::resolveOverlap(std::size_t tool, RobotPose& pose) {
  const std::size_t first = first_link_[tool], end = first_link_[tool + 1];
  bool was_inside = false;
  if (tools_[tool].role == ToolConfig::Role::kGrasper) {
    for (std::size_t link = first; link < end; ++link) {
      was_inside = resolveOverlap(Links{link, link + 1}, pose) || was_inside;
    }
  } else {
    was_inside = resolveOverlap(Links{first, end}, pose);
  }
  if (was_inside) addOnce(tool, report_.were_inside);
}

// A tool that drags tissue out with it that stands through it, as where it went beneath fixed
// nodes, lets go.
void Pipeline::unhook(RobotPose& pose) {
  std::vector<std::size_t> hooked;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (!isHooked(tool)) continue;
    hooked.push_back(tool);
    addOnce(tool, report_.were_inside);
  }
  if (!hooked.empty()) comeAnew(hooked, pose);
}

// Tissue that hangs on what a grasper holds goes through its jaws: where no shape follows it out of
// them when they are told to let go, it comes back without them.
void Pipeline::leaveReleased(RobotPose& pose) {
  std::vector<std::size_t> released;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (jaws_[tool].let_go) released.push_back(tool);
  }
  if (released.empty()) return;
  report_.lost = false;
  comeAnew(released, pose);
}

// The tissue comes back without these tools, and what they still meet they meet from outside.
void Pipeline::comeAnew(const std::vector<std::size_t>& tools, RobotPose& pose) {
  RobotPose without = *last_pose_;
  for (const std::size_t tool : tools) {
    without = withTool(tool, complete({}), without);
    letGoOf(tool);
  }
  last_pose_ = without;
  if (advance(without)) {
    comeAndGo(pose);
  } else {
    startAnew(pose);
  }
  last_pose_ = walk(pose);
}

// Looking for the way out of the tissue takes time: a tool that there is none for stays away in the
// pose, and is behind, once another one came in this step.
bool Pipeline::waitsOutside(std::size_t tool, bool any_came, RobotPose& pose) {
  const bool comes = !isAway(pose.links[first_link_[tool]]);
  if (!comes || !any_came || !isOutOfTime()) return false;
  pose = withTool(tool, complete({}), std::move(pose));
  report_.too_fast = true;
  return true;
}

}  // namespace robot_tissue
