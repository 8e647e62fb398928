// The shape as data, for perception and learning: ~surface and ~nodes. A message is made only where
// somebody listens to its topic, when the shape changed or somebody came, at most at the markers'
// rate; triangles and pieces only when a cut changed them.
#pragma once

#include <robot_tissue/Surface.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "robot_tissue/core/tissue.h"
#include "robot_tissue/ros/update_pace.h"

namespace robot_tissue {

class ShapePublisher {
 public:
  ShapePublisher(ros::NodeHandle& private_node, std::string frame_id, double rate_hz);

  void setRate(double rate_hz) { pace_ = UpdatePace(rate_hz); }
  void shapeChanged() { surface_due_ = nodes_due_ = true; }
  // Where it is due and not too soon. The shape is as it is at `stamp`.
  void publish(const Tissue& tissue, const ros::Time& stamp);
  // Nobody waits for anything.
  bool isUpToDate() const {
    return !isWanted(surface_, surface_due_) && !isWanted(nodes_, nodes_due_);
  }

 private:
  static bool isWanted(const ros::Publisher& topic, bool is_due) {
    return is_due && topic.getNumSubscribers() > 0;
  }
  void takeTopology(const Tissue& tissue);

  std::string frame_id_;
  UpdatePace pace_;
  ros::Publisher surface_, nodes_;
  bool surface_due_ = true;
  bool nodes_due_ = true;
  std::uint32_t topology_ = 0;  // of what follows; 0: of none
  std::vector<int> piece_of_node_;
  Surface message_;  // as last sent; its triangles stay while the topology does
};

}  // namespace robot_tissue
