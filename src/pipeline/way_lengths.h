// How long the tools' ways are, in load steps, and which of them are free.
#pragma once

#include <cstddef>
#include <vector>

#include "world.h"

namespace robot_tissue {

class WayLengths {
 public:
  explicit WayLengths(const World& world) : world_(world) {}

  // Longest load step of a link (m) at a pose, and on the way from one to another.
  double stepOf(std::size_t link, const Pose& tissue_T_link) const;
  double stepOf(std::size_t link, const RobotPose& from, const RobotPose& to) const;
  double stepsBetween(const RobotPose& from, const RobotPose& to) const;
  double freeSteps(const RobotPose& from, const RobotPose& to) const;
  std::vector<std::size_t> farFrom(const RobotPose& from, const RobotPose& goal) const;
  bool touchesTissue(std::size_t tool) const;
  bool passesBy(std::size_t tool, const RobotPose& from, const RobotPose& to) const;
  bool isAt(std::size_t tool, const RobotPose& here, const RobotPose& there) const;

 private:
  // The longest way of a point of the link (m), at most.
  double wayOf(std::size_t link, const RobotPose& from, const RobotPose& to) const;

  const World& world_;
};

}  // namespace robot_tissue
