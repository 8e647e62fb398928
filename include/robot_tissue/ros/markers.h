// The tissue as rviz markers, lists in namespaces that rviz can switch each. A new one is an entry
// of the table in src/ros/markers.cpp. Loading patches are the named ones and what each tool holds
// or touches.
#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/display_surface.h"
#include "robot_tissue/ros/surface_colors.h"

namespace robot_tissue {

struct MarkerStyle {
  double force_scale;  // m/N
  ColorBy color;
};

// A spring on the surface, as it is drawn: along an edge of the surface or, -1, straight.
struct Wire {
  int spring = 0;
  int edge = -1;
};

class MarkerBuilder {
 public:
  MarkerBuilder(std::string frame_id, const MarkerStyle& style,
                std::vector<SupportConfig> supports);

  // reached: stamp of the pose that the forces are of; the shape is as it is at `stamp`.
  visualization_msgs::MarkerArray build(const Pipeline& pipeline, const ros::Time& stamp,
                                        const ros::Time& reached);
  // Of what build() gives, the markers that look otherwise than when this was asked last; all of
  // them after tellAll().
  visualization_msgs::MarkerArray buildChanged(const Pipeline& pipeline, const ros::Time& stamp,
                                               const ros::Time& reached);
  void tellAll() { told_.clear(); }
  void setStyle(const MarkerStyle& style);

 private:
  void findWires(const Tissue& tissue);

  std::string frame_id_;
  MarkerStyle style_;
  std::vector<SupportConfig> supports_;
  std::uint64_t springs_revision_ = 0;  // of the surface that they are of
  std::vector<Wire> wires_;
  DisplaySurface display_;
  double scale_ = 0.0;                            // upper end of the scale of colors
  std::vector<visualization_msgs::Marker> told_;  // in the order of build(), as last told
};

}  // namespace robot_tissue
