#include "robot_tissue/ros/reached_tools.h"

#include "robot_tissue/ros/tool_forces.h"

namespace robot_tissue {
namespace {

void addLine(const std::vector<Vec3>& edge, const Pose& tissue_T_link, std::vector<Vec3>& ends) {
  if (Pipeline::isAway(tissue_T_link)) return;
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    ends.push_back(tissue_T_link * edge[i]);
    ends.push_back(tissue_T_link * edge[i + 1]);
  }
}

std::vector<Vec3> edgesOf(const Pipeline& pipeline) {
  const std::vector<Pose>& links = pipeline.pose()->links;
  std::vector<Vec3> ends;
  std::size_t link = 0;
  for (const ToolGeometry& tool : pipeline.tools()) {
    const std::size_t first = link;
    link += tool.links.size();
    addLine(tool.blade.edge, links[first], ends);
    if (!tool.role.shears) continue;
    for (std::size_t jaw = 0; jaw < 2; ++jaw) {
      addLine(tool.scissors.edges[jaw], links[link - 2 + jaw], ends);
    }
  }
  return ends;
}

// Amid the tool's touches; on a blade, which has none, at its origin.
ReachedTools::Force forceOn(const Pipeline& pipeline, std::size_t tool) {
  const ToolReport& report = pipeline.report().tools[tool];
  ReachedTools::Force force;
  force.force = -forceOnTissue(pipeline, tool);
  force.place = report.contacts > 0 ? report.point : Vec3(poseOf(pipeline, tool).translation());
  if (report.contacts > 0) force.normal = report.normal;
  return force;
}

}  // namespace

ReachedTools reachedTools(const Pipeline& pipeline, const ros::Time& stamp) {
  ReachedTools reached;
  if (!pipeline.pose()) return reached;
  reached.stamp = stamp;
  reached.pose = *pipeline.pose();
  for (std::size_t tool = 0; tool < pipeline.tools().size(); ++tool) {
    reached.forces.push_back(forceOn(pipeline, tool));
  }
  reached.edges = edgesOf(pipeline);
  return reached;
}

}  // namespace robot_tissue
