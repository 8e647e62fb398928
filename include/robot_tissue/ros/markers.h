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

namespace robot_tissue {

class MarkerBuilder {
 public:
  // force_scale in m/N.
  MarkerBuilder(std::string frame_id, double force_scale, std::vector<SupportConfig> supports);

  // reached: stamp of the pose that the forces are of; the shape is as it is at `stamp`.
  visualization_msgs::MarkerArray build(const Pipeline& pipeline, const ros::Time& stamp,
                                        const ros::Time& reached);
  // Of what build() gives, the markers that look otherwise than when this was asked last; all of
  // them after tellAll().
  visualization_msgs::MarkerArray buildChanged(const Pipeline& pipeline, const ros::Time& stamp,
                                               const ros::Time& reached);
  void tellAll() { told_.clear(); }
  void setForceScale(double force_scale) { force_scale_ = force_scale; }  // m/N

 private:
  void findSurfaceSprings(const Tissue& tissue);

  std::string frame_id_;
  double force_scale_;
  std::vector<SupportConfig> supports_;
  std::uint64_t springs_revision_ = 0;  // of the surface that they are of
  std::vector<int> surface_springs_;
  std::vector<visualization_msgs::Marker> told_;  // in the order of build(), as last told
};

}  // namespace robot_tissue
