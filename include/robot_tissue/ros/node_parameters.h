// The node's parameters, checked: scene keys and the node's own, from the private namespace.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "robot_tissue/core/scene.h"
#include "robot_tissue/ros/surface_colors.h"
#include "robot_tissue/scene/scene_parser.h"

namespace robot_tissue {

struct NodeParameters {
  Scene scene;
  double rate_hz = 100.0;          // ~rate: updates, upper bound
  double marker_rate_hz = 30.0;    // ~marker_rate: markers, upper bound
  double wrench_rate_hz = 0.0;     // ~wrench_rate: wrenches; 0: one an update
  double tf_timeout_s = 0.5;       // ~tf_timeout: an older pose is stale
  double force_scale = 0.02;       // ~force_scale: length of a force arrow (m/N)
  ColorBy color = ColorBy::kNone;  // ~color: what the surface's color tells
  std::string state_dir;           // ~state_dir: where saved states are; empty: not said
  std::string robot_description_param = "robot_description";  // ~robot_description_param
};

// Of an update, and of a service's call (s).
double updateBudget(const NodeParameters& parameters);
// Of a load step (solver.max_iterations); 0: any number.
int mostIterations(const NodeParameters& parameters);

// Of a scene's text, which may hold the node's own parameters, too; the scene as its user takes it.
// Throws InputError.
NodeParameters parseNodeParameters(const YAML::Node& root, SceneSource source);
// Throws InputError.
NodeParameters readNodeParameters(const ros::NodeHandle& private_node);

}  // namespace robot_tissue
