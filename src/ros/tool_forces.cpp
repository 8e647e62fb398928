#include "robot_tissue/ros/tool_forces.h"

namespace robot_tissue {

Vec3 forceOnTissue(const Pipeline& pipeline, std::size_t tool) {
  if (!pipeline.pose()) return Vec3::Zero();
  std::size_t first_link = 0;
  for (std::size_t before = 0; before < tool; ++before) {
    first_link += pipeline.tools()[before].links.size();
  }
  const Pose& tissue_T_tool = pipeline.pose()->links[first_link];
  return -(tissue_T_tool.linear() * pipeline.report().tools[tool].force_on_tool);
}

}  // namespace robot_tissue
