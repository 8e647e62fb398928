// How a tool gets out of the tissue that it appeared inside, or is stuck in.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "world.h"

namespace robot_tissue {

class OverlapResolver {
 public:
  explicit OverlapResolver(World& world) : world_(world) {}

  bool isInTissue(std::size_t tool, const RobotPose& pose) const;
  void resolveOverlap(std::size_t tool, RobotPose& pose);

 private:
  static RobotPose moved(const Links& links, const Vec3& way, RobotPose pose);
  ContactSet overlapOf(const Links& links, const RobotPose& pose) const;
  std::optional<Vec3> middleBeneath(const Links& links, const RobotPose& pose) const;
  bool isInTissue(const Links& links, const RobotPose& pose) const;
  std::vector<Vec3> waysOut(const Links& links, const RobotPose& pose) const;
  std::optional<int> stepsOut(const Links& links, const RobotPose& pose, const Vec3& way,
                              int most) const;
  bool resolveOverlap(const Links& links, RobotPose& pose) const;

  World& world_;
};

}  // namespace robot_tissue
