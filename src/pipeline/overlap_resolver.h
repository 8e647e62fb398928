// How a tool gets out of the tissue that it appeared inside, or is stuck in.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "world.h"

namespace robot_tissue {

class OverlapResolver {
 public:
  // kShut: with no room for tissue between them.
  enum class JawsStand { kApart, kShut };

  explicit OverlapResolver(const World& world) : world_(world) {}

  bool isInTissue(std::size_t tool, const RobotPose& pose) const;
  // Whether the tool is in the tissue neither as that is nor as it is at rest.
  bool isClear(std::size_t tool, const RobotPose& pose) const;
  // Moves the tool in the pose until it is out of the tissue. True: it was inside.
  bool resolveOverlap(std::size_t tool, JawsStand jaws, RobotPose& pose) const;

 private:
  static RobotPose moved(const Links& links, const Vec3& way, RobotPose pose);
  ContactSet overlapOf(const Links& links, const RobotPose& pose) const;
  ContactSet overlapOf(const Links& links, const RobotPose& pose,
                       const std::vector<Vec3>& vertices) const;
  std::optional<Vec3> pointBeneath(const Links& links, const RobotPose& pose) const;
  std::optional<Vec3> pointBeneath(const Links& links, const RobotPose& pose,
                                   const std::vector<Vec3>& vertices) const;
  bool isInTissue(const Links& links, const RobotPose& pose) const;
  std::optional<double> depthIn(const Links& links, const RobotPose& pose) const;
  std::vector<Vec3> waysOut(const Links& links, const RobotPose& pose) const;
  bool isOut(const Links& links, const RobotPose& pose) const;
  std::optional<bool> givesWay(const ContactSet& overlap) const;
  bool leavesByWhatGivesWay(const Links& links, const RobotPose& pose, const Vec3& step) const;
  std::optional<int> stepsOut(const Links& links, const RobotPose& pose, const Vec3& way,
                              int most) const;
  bool resolveOverlap(const Links& links, RobotPose& pose) const;

  const World& world_;
};

}  // namespace robot_tissue
