// The node's services: a request succeeds as a whole or leaves everything as it was.
#pragma once

#include <robot_tissue/ApplyLoad.h>
#include <robot_tissue/Cut.h>
#include <robot_tissue/Tool.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <cstddef>
#include <functional>
#include <string>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/tissue_publisher.h"
#include "robot_tissue/ros/tool_poses.h"

namespace robot_tissue {

class TissueServices {
 public:
  // What the services ask of the node.
  struct Node {
    // Before each request: it may give something to do at a pose at which there was nothing.
    std::function<void()> wake;
    std::function<bool()> has_pose;
    std::function<void()> follow;  // the pose that it has
    std::function<void()> settle_from_rest;
  };

  // What is handed in must outlive them.
  TissueServices(ros::NodeHandle& private_node, const NodeParameters& parameters,
                 Pipeline& pipeline, TissuePublisher& publisher, const ToolPoses& tool_poses,
                 Node node);

 private:
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onCut(Cut::Request& request, Cut::Response& response);
  bool onApplyLoad(ApplyLoad::Request& request, ApplyLoad::Response& response);
  void loadPatch(const ApplyLoad::Request& request, ApplyLoad::Response& response);
  // tool_services.cpp
  void requireBox(const ApplyLoad::Request& request) const;
  bool onGrasp(Tool::Request& request, Tool::Response& response);
  bool onRelease(Tool::Request& request, Tool::Response& response);
  void pushTool(const ApplyLoad::Request& request, ApplyLoad::Response& response);
  std::string followPush(std::size_t tool, bool is_pushed);
  bool isTool(const std::string& name) const;
  std::size_t toolIndex(const std::string& name) const;
  template <class Request, class Response>
  ros::ServiceServer advertise(ros::NodeHandle& private_node, const std::string& name,
                               bool (TissueServices::*answer)(Request&, Response&));

  const NodeParameters& parameters_;
  Pipeline& pipeline_;
  TissuePublisher& publisher_;
  const ToolPoses& tool_poses_;
  Node node_;
  ros::ServiceServer reset_, cut_, load_, grasp_, release_;
};

}  // namespace robot_tissue
