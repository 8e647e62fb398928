// The edges of tools that cut, where the tissue has met them.
#include "drawn_state.h"
#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/tool_forces.h"
#include "tuning.h"

namespace robot_tissue {

void drawEdges(const Drawn& drawn, visualization_msgs::Marker lines,
               visualization_msgs::MarkerArray& array) {
  lines.scale.x = tuning::kEdgeWidth;
  std::vector<Vec3> ends;
  for (std::size_t tool = 0; tool < drawn.pipeline.tools().size(); ++tool) {
    const std::vector<Vec3>& edge = drawn.pipeline.tools()[tool].blade.edge;
    if (!drawn.pipeline.pose() || edge.empty()) continue;
    const Pose& tissue_T_tool = poseOf(drawn.pipeline, tool);
    if (tissue_T_tool.translation() == Pipeline::away().translation()) continue;
    for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
      ends.push_back(tissue_T_tool * edge[i]);
      ends.push_back(tissue_T_tool * edge[i + 1]);
    }
  }
  lines.points = toPoints(ends);
  add(std::move(lines), array);
}

}  // namespace robot_tissue
