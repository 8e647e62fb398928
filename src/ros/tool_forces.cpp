#include "robot_tissue/ros/tool_forces.h"

namespace robot_tissue {

const Pose& poseOf(const Pipeline& pipeline, std::size_t tool) {
  std::size_t first_link = 0;
  for (std::size_t before = 0; before < tool; ++before) {
    first_link += pipeline.tools()[before].links.size();
  }
  return pipeline.pose()->links[first_link];
}

Vec3 forceOnTissue(const Pipeline& pipeline, std::size_t tool) {
  if (!pipeline.pose()) return Vec3::Zero();
  return -(poseOf(pipeline, tool).linear() * pipeline.report().tools[tool].force_on_tool);
}

}  // namespace robot_tissue
