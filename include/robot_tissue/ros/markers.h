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
#include "robot_tissue/ros/reached_tools.h"
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

  // Forces, normals and edges are drawn as they were when the tissue last reached a pose: this one,
  // with its stamp.
  struct News {
    bool forces = false;
    bool others = false;
    bool any() const { return forces || others; }
  };
  News reach(const Pipeline& pipeline, const ros::Time& stamp);
  // The tools went on since, or have no pose: those are drawn dimmed, numbers in parentheses. After
  // tools were told to stand nowhere, they are gone. True: that is news.
  bool fallBehind(const Pipeline& pipeline);
  void forgetTools();
  const ros::Time& reachedAt() const { return tools_.stamp; }  // zero: no pose yet

  // The shape is as it is at `stamp`.
  visualization_msgs::MarkerArray build(const Pipeline& pipeline, const ros::Time& stamp);
  enum class What { kAll, kTools };  // kTools: what hangs on reach() and fallBehind() alone
  // Of what build() gives, the markers that look otherwise than when this was asked last; all of
  // them after tellAll().
  visualization_msgs::MarkerArray buildChanged(const Pipeline& pipeline, const ros::Time& stamp,
                                               What what);
  void tellAll() { told_.clear(); }
  void setStyle(const MarkerStyle& style);

 private:
  std::vector<visualization_msgs::MarkerArray> draw(const Pipeline& pipeline,
                                                    const ros::Time& stamp, What what);
  std::vector<double> followShape(const Pipeline& pipeline);
  void findWires(const Tissue& tissue);

  std::string frame_id_;
  MarkerStyle style_;
  std::vector<SupportConfig> supports_;
  std::uint64_t springs_revision_ = 0;  // of the surface that they are of
  std::vector<Wire> wires_;
  DisplaySurface display_;
  double scale_ = 0.0;  // upper end of the scale of colors
  ReachedTools tools_;
  bool is_behind_ = false;
  std::vector<std::vector<visualization_msgs::Marker>> told_;  // as draw() gives them, last told
};

}  // namespace robot_tissue
