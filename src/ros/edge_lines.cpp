// The edges of tools that cut, where the tissue has followed them.
#include "drawn_state.h"
#include "robot_tissue/ros/conversions.h"
#include "tuning.h"

namespace robot_tissue {

void drawEdges(const Drawn& drawn, const visualization_msgs::Marker& blank,
               visualization_msgs::MarkerArray& array) {
  visualization_msgs::Marker lines = blank;
  lines.scale.x = tuning::kEdgeWidth;
  lines.points = toPoints(drawn.tools.edges);
  add(std::move(lines), array);
}

}  // namespace robot_tissue
