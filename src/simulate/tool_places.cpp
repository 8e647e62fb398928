#include "tool_places.h"

#include <stdexcept>

#include "robot_tissue/pipeline/between.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

MoveStep::Place between(const MoveStep::Place& from, const MoveStep::Place& to, double share) {
  if (share >= 1.0) return to;
  MoveStep::Place place;
  place.pose = between(from.pose, to.pose, share);
  place.opening = from.opening + share * (to.opening - from.opening);
  return place;
}

std::size_t ToolPlaces::indexOf(const std::string& name) const {
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (tools_[tool].name == name) return tool;
  }
  throw std::logic_error("no tool has the name " + name);
}

RobotPose ToolPlaces::pose() const {
  RobotPose pose;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    for (std::size_t link = 0; link < tools_[tool].links.size(); ++link) {
      pose.links.push_back(places_[tool] ? places_[tool]->pose : Pipeline::away());
      if (places_[tool]) pose.links.back().translate(shift(tool, link));
    }
  }
  return pose;
}

std::size_t ToolPlaces::firstLink(std::size_t tool) const {
  std::size_t first = 0;
  for (std::size_t earlier = 0; earlier < tool; ++earlier) first += tools_[earlier].links.size();
  return first;
}

Vec3 ToolPlaces::originInFirstLink(std::size_t tool) const { return -shift(tool, 0); }

// Where a link stands from the tool's pose, in the tool's frame (m).
Vec3 ToolPlaces::shift(std::size_t tool, std::size_t link) const {
  const ToolConfig& config = tools_[tool];
  const std::size_t jaw = config.links.size() - 2;
  if (!config.role.has_jaws || link < jaw) return Vec3::Zero();
  return (link == jaw ? 0.5 : -0.5) * places_[tool]->opening * config.grasp.opening_axis;
}

}  // namespace robot_tissue
