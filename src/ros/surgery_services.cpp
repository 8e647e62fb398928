#include "robot_tissue/ros/surgery_services.h"

#include <utility>

#include "robot_tissue/scene/state_file.h"

namespace robot_tissue {

template <class Service>
void SurgeryServices::advertise(ros::NodeHandle& private_node, const std::string& name,
                                void (SurgeryServices::*answer)(const typename Service::Request&,
                                                                typename Service::Response&)) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> answers = [this, answer](Request& request,
                                                                            Response& response) {
    wake_();
    try {
      (this->*answer)(request, response);
      response.success = true;
    } catch (const InputError& error) {
      response.success = false;
      response.message = error.what();
    }
    return true;
  };
  servers_.push_back(private_node.advertiseService(name, answers));
}

SurgeryServices::SurgeryServices(ros::NodeHandle& private_node, std::string state_dir,
                                 Pipeline& pipeline, TissuePublisher& publisher,
                                 std::function<void()> wake)
    : state_dir_(std::move(state_dir)),
      pipeline_(pipeline),
      publisher_(publisher),
      wake_(std::move(wake)) {
  advertise<File>(private_node, "save_state", &SurgeryServices::onSaveState);
  advertise<File>(private_node, "load_state", &SurgeryServices::onLoadState);
}

void SurgeryServices::onSaveState(const File::Request& request, File::Response& response) {
  const std::string bytes = pipeline_.tissue().savedState();
  writeStateFile(state_dir_, request.file, bytes);
  response.message = "saved " + std::to_string(bytes.size()) + " bytes in " + state_dir_;
}

void SurgeryServices::onLoadState(const File::Request& request, File::Response& response) {
  const std::string bytes = readStateFile(state_dir_, request.file);
  SolveReport report;
  try {
    report = pipeline_.loadState(bytes);
  } catch (const InputError& error) {
    throw InputError("file = '" + request.file + "': " + error.what());
  }
  publisher_.shapeChanged();
  response.message = "loaded";
  if (report.status != SolveStatus::kOk) {
    response.message += std::string("; ") + toString(report.status);
  }
}

}  // namespace robot_tissue
