// Services that change the tissue as a surgeon does, and take that back: a request succeeds as a
// whole or leaves everything as it was.
#pragma once

#include <robot_tissue/File.h>
#include <robot_tissue/Remove.h>
#include <robot_tissue/Suture.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/tissue_publisher.h"
#include "robot_tissue/ros/tool_poses.h"

namespace robot_tissue {

class SurgeryServices {
 public:
  // The arguments must outlive the services. `wake` is called before each request.
  SurgeryServices(ros::NodeHandle& private_node, std::string state_dir, Pipeline& pipeline,
                  TissuePublisher& publisher, const ToolPoses& tool_poses,
                  std::function<void()> wake);

 private:
  void onSaveState(const File::Request& request, File::Response& response);
  void onLoadState(const File::Request& request, File::Response& response);
  void onRemove(const Remove::Request& request, Remove::Response& response);
  void onUndo(const std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onSuture(const Suture::Request& request, Suture::Response& response);
  template <class Service>
  void advertise(ros::NodeHandle& private_node, const std::string& name,
                 void (SurgeryServices::*answer)(const typename Service::Request&,
                                                 typename Service::Response&));

  std::string state_dir_;
  Pipeline& pipeline_;
  TissuePublisher& publisher_;
  const ToolPoses& tool_poses_;
  std::function<void()> wake_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace robot_tissue
