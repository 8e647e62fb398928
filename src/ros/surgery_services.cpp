#include "robot_tissue/ros/surgery_services.h"

#include <array>
#include <utility>

#include "robot_tissue/core/suture_ranges.h"
#include "robot_tissue/pipeline/suture_names.h"
#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/node_status.h"
#include "robot_tissue/ros/request_checks.h"
#include "robot_tissue/scene/patch_name.h"
#include "robot_tissue/scene/state_file.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

// Of a request without a radius.
void requireVolume(const Vec3& low, const Vec3& high) {
  if (low.isZero(0.0) && high.isZero(0.0)) {
    throw InputError("min, max, radius: all 0; allowed: min below max, or a radius above 0");
  }
  requireBelow(low, high, FlatBox::kRefused);
}

RemovedSpace spaceOf(const Remove::Request& request, const Pose& tissue_T_frame) {
  const Vec3 low = toVec3(request.min), high = toVec3(request.max), center = toVec3(request.center);
  requireWithin(low, kFarthestPoint, "m", "min");
  requireWithin(high, kFarthestPoint, "m", "max");
  requireWithin(center, kFarthestPoint, "m", "center");
  requireWithin(Vec3(request.radius, 0.0, 0.0), kFarthestPoint, "m", "radius");
  if (request.radius == 0.0) {
    requireVolume(low, high);
    return PlacedBox{Box(low, high), tissue_T_frame};
  }
  if (request.radius < 0.0) {
    throw InputError("radius: " + numberText(request.radius) +
                     " m; allowed: above 0, or 0: the box of min and max");
  }
  if (!low.isZero(0.0) || !high.isZero(0.0)) {
    throw InputError("min, max, radius: a box and a sphere given; allowed: one of them");
  }
  return Sphere{tissue_T_frame * center, request.radius};
}

void requireStiffness(double stiffness) {
  if (stiffness == 0.0 || (stiffness >= kSoftestSuture && stiffness <= kStiffestSuture)) return;
  throw InputError(
      "stiffness: " + numberText(stiffness) + "; allowed: " + numberText(kSoftestSuture) + " to " +
      numberText(kStiffestSuture) + " N/m, or 0: " + numberText(SutureConfig().stiffness));
}

// Of one that speaks of a scene, where the ends of a suture are `from` and `to`.
std::string inWordsOfRequest(std::string message) {
  const std::array<std::pair<std::string, std::string>, 3> words = {
      {{": from = ", ": start = "},
       {": to = ", ": end = "},
       {": from and to ", ": start and end "}}};
  for (const auto& [of_scene, of_request] : words) {
    const std::size_t place = message.find(of_scene);
    if (place != std::string::npos) message.replace(place, of_scene.size(), of_request);
  }
  return message;
}

// Throws InputError in the words of the request.
SutureResult sutured(Pipeline& pipeline, const SutureConfig& suture) {
  try {
    return pipeline.suture(suture);
  } catch (const InputError& error) {
    throw InputError(inWordsOfRequest(error.what()));
  }
}

}  // namespace

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
                                 const ToolPoses& tool_poses, std::function<void()> wake)
    : state_dir_(std::move(state_dir)),
      pipeline_(pipeline),
      publisher_(publisher),
      tool_poses_(tool_poses),
      wake_(std::move(wake)) {
  advertise<File>(private_node, "save_state", &SurgeryServices::onSaveState);
  advertise<File>(private_node, "load_state", &SurgeryServices::onLoadState);
  advertise<Remove>(private_node, "remove", &SurgeryServices::onRemove);
  advertise<std_srvs::Trigger>(private_node, "undo", &SurgeryServices::onUndo);
  advertise<Suture>(private_node, "suture", &SurgeryServices::onSuture);
}

void SurgeryServices::onSaveState(const File::Request& request, File::Response& response) {
  const std::string bytes = pipeline_.tissue().savedState();
  const bool replaced = writeStateFile(state_dir_, request.file, bytes);
  response.message = "saved " + std::to_string(bytes.size()) + " bytes in " + state_dir_ + "/" +
                     request.file + (replaced ? ", in the place of an earlier file" : "");
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
  response.message = "loaded" + endOfAnswer(report, pipeline_);
}

void SurgeryServices::onRemove(const Remove::Request& request, Remove::Response& response) {
  response.pieces = pipeline_.tissue().state().pieces;
  const Pose tissue_T_frame = tool_poses_.frame(request.header);
  const RemoveReport report = pipeline_.remove(spaceOf(request, tissue_T_frame));
  publisher_.shapeChanged();
  response.volume = report.volume;
  response.pieces = report.pieces;
  response.message = report.volume > 0.0 ? "removed" : "no cell has its center in the space";
  for (const std::string& load : report.loads) response.message += ", load '" + load + "' with it";
  response.message += endOfAnswer(report.solve, pipeline_);
}

void SurgeryServices::onUndo(const std_srvs::Trigger::Request&,
                             std_srvs::Trigger::Response& response) {
  if (pipeline_.tissue().undoable() == 0) {
    throw InputError(
        "nothing to take back; allowed: after a cut, a removal, a tear or a suture since the "
        "start, a reset or a loaded state");
  }
  const SolveReport report = pipeline_.undo(1);
  publisher_.shapeChanged();
  response.message = "taken back, " + std::to_string(pipeline_.tissue().undoable()) +
                     " more to take back" + endOfAnswer(report, pipeline_);
  if (pipeline_.tissue().isOverstretched()) {
    response.message += "; what tore is stretched too far still, and tears again";
  }
}

void SurgeryServices::onSuture(const Suture::Request& request, Suture::Response& response) {
  const Pose tissue_T_request = tool_poses_.frame(request.header);
  SutureConfig suture;
  suture.name = request.name.empty() ? freeSutureName(pipeline_.tissue()) : request.name;
  requirePatchName(suture.name);
  suture.from = toVec3(request.start);
  suture.to = toVec3(request.end);
  requireWithin(suture.from, kFarthestPoint, "m", "start");
  requireWithin(suture.to, kFarthestPoint, "m", "end");
  suture.from = tissue_T_request * suture.from;
  suture.to = tissue_T_request * suture.to;
  suture.rest_length = request.rest_length;
  requireStiffness(request.stiffness);
  if (request.stiffness != 0.0) suture.stiffness = request.stiffness;
  suture.break_force = request.break_force;
  suture.bite = request.bite;
  const SutureResult result = sutured(pipeline_, suture);
  publisher_.shapeChanged();
  response.name = suture.name;
  response.tension = result.suture.tension;
  response.message = result.suture.broken ? "sutured, and broken at once" : "sutured";
  response.message += endOfAnswer(result.solve, pipeline_);
}

}  // namespace robot_tissue
