// The parameters that may change while the node runs (doc/node.md), checked as at its start. A new
// one is an entry of the table in src/ros/live_parameters.cpp.
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <optional>

#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/reconfigure_server.h"

namespace robot_tissue {

// Of the first tool that has friction; empty: none has.
std::optional<double> frictionOf(const NodeParameters& parameters);

// Throws InputError where a region or membrane is too stiff, or too soft, beside this modulus.
void requireContrasts(double young_modulus, const TissueConfig& tissue);

class LiveParameters {
 public:
  // Makes the node what the parameters say.
  using Apply = std::function<void(const NodeParameters&)>;

  // What a request leaves alone is as in `parameters` then, which must outlive this.
  LiveParameters(const ros::NodeHandle& private_node, const NodeParameters& parameters,
                 Apply apply);

 private:
  void change(const ReconfigureServer::Values& values);

  ros::NodeHandle private_node_;
  const NodeParameters& parameters_;
  Apply apply_;
  ReconfigureServer server_;
};

}  // namespace robot_tissue
