// The state of the tissue that the markers are drawn from.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <utility>
#include <vector>

#include "robot_tissue/ros/markers.h"
#include "robot_tissue/ros/reached_tools.h"

namespace robot_tissue {

// Of the tissue at rest (m): letters, arrows and the legend are as large to it everywhere.
inline double diagonalOf(const Tissue& tissue) {
  return tissue.lattice().bounds().diagonal().norm();
}

// Of the force of the tissue on a tool.
struct ForceArrow {
  Vec3 start, tip;  // m, tissue frame
  Vec3 away;        // unit: from the tool, and so to the place of its number
  double force;     // N
};

// Per tool; empty where there is no force.
using ForceArrows = std::vector<std::optional<ForceArrow>>;
ForceArrows forceArrows(const Pipeline& pipeline, const ReachedTools& tools,
                        double force_scale);  // m/N

struct Drawn {
  const Pipeline& pipeline;
  const std::vector<SupportConfig>& supports;
  const DisplaySurface& display;
  const std::vector<Wire>& wires;
  const MarkerStyle& style;
  const std::vector<double>& values;  // of the surface's color; empty: it has none
  double scale;                       // its upper end, in the unit of the values
  const ReachedTools& tools;
  const ForceArrows& arrows;
  bool is_behind;  // the tools are no more where those are of

  const Tissue& tissue() const { return pipeline.tissue(); }
  double spacing() const { return tissue().lattice().spacing(); }
  double diagonal() const { return diagonalOf(tissue()); }
};

// rviz refuses an empty list or text: the marker is taken away instead.
inline void add(visualization_msgs::Marker marker, visualization_msgs::MarkerArray& array) {
  if (marker.points.empty() && marker.text.empty()) {
    marker.action = visualization_msgs::Marker::DELETE;
  }
  array.markers.push_back(std::move(marker));
}

// Each takes a marker with all but its places and sizes, and adds such with them.
void drawNormals(const Drawn& drawn, const visualization_msgs::Marker& blank,
                 visualization_msgs::MarkerArray& array);
void drawForces(const Drawn& drawn, const visualization_msgs::Marker& blank,
                visualization_msgs::MarkerArray& array);
void drawForceLabels(const Drawn& drawn, const visualization_msgs::Marker& blank,
                     visualization_msgs::MarkerArray& array);
void drawForceList(const Drawn& drawn, const visualization_msgs::Marker& blank,
                   visualization_msgs::MarkerArray& array);
void drawEdges(const Drawn& drawn, const visualization_msgs::Marker& blank,
               visualization_msgs::MarkerArray& array);
void drawLegend(const Drawn& drawn, const visualization_msgs::Marker& blank,
                visualization_msgs::MarkerArray& array);

}  // namespace robot_tissue
