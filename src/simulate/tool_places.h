// Where the tools of the runner stand. It has no URDF: all links of a tool are at the tool's pose,
// but a grasper's two jaws, half its opening to either side of that along grasp.opening_axis.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Straight from one to the other at an even rate; share 0: from, 1: to.
MoveStep::Place between(const MoveStep::Place& from, const MoveStep::Place& to, double share);

class ToolPlaces {
 public:
  explicit ToolPlaces(std::vector<ToolConfig> tools) : tools_(std::move(tools)) { takeAway(); }

  std::size_t count() const { return tools_.size(); }
  const std::string& name(std::size_t tool) const { return tools_[tool].name; }
  std::size_t indexOf(const std::string& name) const;

  bool anyStands() const {
    return std::any_of(places_.begin(), places_.end(), [](const auto& place) { return !!place; });
  }
  // Empty: the tool stands nowhere.
  const std::optional<MoveStep::Place>& of(std::size_t tool) const { return places_[tool]; }
  void put(std::size_t tool, const MoveStep::Place& place) { places_[tool] = place; }
  void takeAway(std::size_t tool) { places_[tool].reset(); }
  void takeAway() { places_.assign(tools_.size(), std::nullopt); }

  // The poses of all links; those of tools that stand nowhere are far away.
  RobotPose pose() const;
  // Index into RobotPose::links of the tool's first link.
  std::size_t firstLink(std::size_t tool) const;
  // Where the tool's own origin is in the frame of its first link (m).
  Vec3 originInFirstLink(std::size_t tool) const;

 private:
  Vec3 shift(std::size_t tool, std::size_t link) const;

  std::vector<ToolConfig> tools_;
  std::vector<std::optional<MoveStep::Place>> places_;
};

}  // namespace robot_tissue
