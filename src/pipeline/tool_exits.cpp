// Pipeline: how a tool that appeared inside the tissue gets out of it.
#include <algorithm>
#include <cmath>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tool_list.h"

namespace robot_tissue {
namespace {

Vec3 outwardArea(const std::vector<Vec3>& vertices, const MeshTriangle& corners) {
  const Vec3& a = vertices[at(corners[0])];
  return (vertices[at(corners[1])] - a).cross(vertices[at(corners[2])] - a);
}

void addUnit(const Vec3& way, std::vector<Vec3>& ways) {
  if (way.norm() > 0.0) ways.push_back(way.normalized());
}

}  // namespace

RobotPose Pipeline::moved(std::size_t tool, const Vec3& way, RobotPose pose) const {
  for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
    pose.links[link].translation() += way;
  }
  return pose;
}

// Of the tool alone, without its gaps. Supports always stand in the pose.
ContactSet Pipeline::overlapOf(std::size_t tool, const RobotPose& pose) const {
  const RobotPose alone = withTool(tool, pose, complete({}));
  ContactSet overlap = finder_.find(alone, tissue_.surface(), tissue_.vertices(), 0.0);
  auto& all = overlap.contacts;
  const auto is_others = [tool](const Contact& contact) { return at(contact.tool) != tool; };
  all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
  return overlap;
}

// Of the tool's first link whose middle is beneath the surface: that middle.
std::optional<Vec3> Pipeline::middleBeneath(std::size_t tool, const RobotPose& pose) const {
  for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
    if (isAway(pose.links[link]) || finder_.reach(link) <= 0.0) continue;
    const Vec3 middle = pose.links[link] * finder_.center(link);
    if (encloses(tissue_.vertices(), tissue_.surface().triangles, middle)) return middle;
  }
  return std::nullopt;
}

bool Pipeline::isInTissue(std::size_t tool, const RobotPose& pose) const {
  return deepest(overlapOf(tool, pose)) > 0.0 || middleBeneath(tool, pose).has_value();
}

// Unit directions out of the tissue that may be short: as the surface looks where the tool goes
// through it, against the contacts' normals, from its middle to the nearest vertex of the surface,
// and along the axes.
std::vector<Vec3> Pipeline::waysOut(std::size_t tool, const RobotPose& pose) const {
  const std::vector<Vec3>& vertices = tissue_.vertices();
  Vec3 as_surface = Vec3::Zero(), against_tool = Vec3::Zero();
  for (const Contact& contact : overlapOf(tool, pose).contacts) {
    const MeshTriangle& corners = tissue_.surface().triangles[at(contact.triangle)];
    as_surface += contact.depth_m * outwardArea(vertices, corners);
    against_tool -= contact.depth_m * contact.normal;
  }
  std::vector<Vec3> ways;
  addUnit(as_surface, ways);
  addUnit(against_tool, ways);
  if (const auto middle = middleBeneath(tool, pose)) {
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

// Steps of one spacing along a way until the tool is out; nothing when these are not fewer than
// `most`, or the last of the tissue on the way is one that gives no way back in.
std::optional<int> Pipeline::stepsOut(std::size_t tool, const RobotPose& pose, const Vec3& way,
                                      int most) const {
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  bool gives_way = false;
  for (int steps = 0; steps < most; ++steps) {
    const RobotPose there = moved(tool, steps * tissue_.lattice().spacing() * way, pose);
    const ContactSet overlap = overlapOf(tool, there);
    if (deepest(overlap) <= 0.0 && !middleBeneath(tool, there)) {
      return gives_way ? std::optional<int>(steps) : std::nullopt;
    }
    if (!overlap.contacts.empty()) gives_way = false;
    for (const Contact& contact : overlap.contacts) {
      gives_way = gives_way ||
                  ToolContacts::givesWay(
                      carriersAt(tissue_.surface(), contact.triangle, contact.barycentric), held);
    }
  }
  return std::nullopt;
}

// Draws a tool that is in the tissue back, step by step, until it is out, by the shortest way.
void Pipeline::drawOut(std::size_t tool, RobotPose& pose) {
  if (!isInTissue(tool, pose)) return;
  addOnce(tool, report_.were_inside);
  const std::vector<Vec3> ways = waysOut(tool, pose);
  Vec3 shortest = ways.front();
  int fewest = kMostLoadSteps / 5;
  for (const Vec3& way : ways) {
    if (const auto steps = stepsOut(tool, pose, way, fewest)) {
      shortest = way;
      fewest = *steps;
    }
  }
  for (int step = 0; step < kMostLoadSteps && isInTissue(tool, pose); ++step) {
    pose = moved(tool, tissue_.stepLength() * shortest, std::move(pose));
  }
}

}  // namespace robot_tissue
