// The tissue as rviz markers, lists in namespaces that rviz can switch each:
//   surface, cut_faces            triangles of the displayed surface
//   wireframe                     springs between surface nodes, cut ones left out
//   fixed_nodes, loading_patches  nodes as spheres
//   contact_normals, contact_forces   an arrow a tool; normal into the tissue, force on the tissue
//   supports                      a box each; of a plane a thin one under the tissue
// Loading patches are the named ones and what each tool holds or touches.
#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

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

 private:
  visualization_msgs::Marker make(const std::string& ns, int id, int type) const;
  void addSurface(const Tissue& tissue, visualization_msgs::MarkerArray& array) const;
  void addWireframe(const Tissue& tissue, visualization_msgs::MarkerArray& array);
  void addFixedNodes(const Tissue& tissue, visualization_msgs::MarkerArray& array) const;
  void addLoadedNodes(const Pipeline& pipeline, visualization_msgs::MarkerArray& array) const;
  void addContacts(const Pipeline& pipeline, visualization_msgs::MarkerArray& array) const;
  void addSupports(const Lattice& lattice, visualization_msgs::MarkerArray& array) const;
  void findSurfaceSprings(const Tissue& tissue);

  std::string frame_id_;
  double force_scale_;
  std::vector<SupportConfig> supports_;
  ros::Time stamp_;
  unsigned springs_version_ = 0;
  std::vector<int> surface_springs_;
  std::vector<visualization_msgs::Marker> told_;  // in the order of build(), as last told
};

}  // namespace robot_tissue
