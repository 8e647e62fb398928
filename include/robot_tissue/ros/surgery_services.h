// Services that change the tissue as a surgeon does, and take that back: a request succeeds as a
// whole or leaves everything as it was.
#pragma once

#include <robot_tissue/File.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <functional>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/tissue_publisher.h"

namespace robot_tissue {

class SurgeryServices {
 public:
  // The arguments must outlive the services. `wake` is called before each request.
  SurgeryServices(ros::NodeHandle& private_node, std::string state_dir, Pipeline& pipeline,
                  TissuePublisher& publisher, std::function<void()> wake);

 private:
  void onSaveState(const File::Request& request, File::Response& response);
  void onLoadState(const File::Request& request, File::Response& response);
  template <class Service>
  void advertise(ros::NodeHandle& private_node, const std::string& name,
                 void (SurgeryServices::*answer)(const typename Service::Request&,
                                                 typename Service::Response&));

  std::string state_dir_;
  Pipeline& pipeline_;
  TissuePublisher& publisher_;
  std::function<void()> wake_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace robot_tissue
