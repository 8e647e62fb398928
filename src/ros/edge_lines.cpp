// The edges of tools that cut, where the tissue has followed them.
#include "drawn_state.h"
#include "robot_tissue/ros/conversions.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

void addLine(const std::vector<Vec3>& edge, const Pose& tissue_T_link, std::vector<Vec3>& ends) {
  if (tissue_T_link.translation() == Pipeline::away().translation()) return;
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    ends.push_back(tissue_T_link * edge[i]);
    ends.push_back(tissue_T_link * edge[i + 1]);
  }
}

}  // namespace

void drawEdges(const Drawn& drawn, visualization_msgs::Marker lines,
               visualization_msgs::MarkerArray& array) {
  lines.scale.x = tuning::kEdgeWidth;
  std::vector<Vec3> ends;
  std::size_t link = 0;
  for (const ToolGeometry& tool : drawn.pipeline.tools()) {
    const std::size_t first = link;
    link += tool.links.size();
    if (!drawn.pipeline.pose()) continue;
    const std::vector<Pose>& links = drawn.pipeline.pose()->links;
    addLine(tool.blade.edge, links[first], ends);
    if (!tool.role.shears) continue;
    for (std::size_t jaw = 0; jaw < 2; ++jaw) {
      addLine(tool.scissors.edges[jaw], links[link - 2 + jaw], ends);
    }
  }
  lines.points = toPoints(ends);
  add(std::move(lines), array);
}

}  // namespace robot_tissue
