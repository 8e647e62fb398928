#include "robot_tissue/ros/tissue_services.h"

#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/node_status.h"
#include "robot_tissue/ros/request_checks.h"
#include "robot_tissue/scene/patch_name.h"
#include "robot_tissue/scene/ranges.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Its corners, in its own frame.
std::vector<Vec3> cornersOf(const Cut::Request& request) {
  if (request.corners.size() > ranges::kMostCutCorners) {
    throw InputError("corners: " + std::to_string(request.corners.size()) +
                     " given; allowed: at most " + std::to_string(ranges::kMostCutCorners));
  }
  std::vector<Vec3> corners;
  for (const auto& corner : request.corners) {
    corners.push_back(toVec3(corner));
    const std::string field = "corners[" + std::to_string(corners.size() - 1) + "]";
    requireWithin(corners.back(), kFarthestPoint, "m", field);
  }
  return corners;
}

PatchConfig patchOf(const ApplyLoad::Request& request) {
  PatchConfig patch;
  patch.name = request.name;
  patch.box = {toVec3(request.min), toVec3(request.max)};
  requireWithin(patch.box.min(), kFarthestPoint, "m", "min");
  requireWithin(patch.box.max(), kFarthestPoint, "m", "max");
  requireBelow(patch.box.min(), patch.box.max(), FlatBox::kAllowed);
  if (request.displacement.size() + request.force.size() > 1) {
    throw InputError("displacement, force: " + std::to_string(request.displacement.size()) +
                     " and " + std::to_string(request.force.size()) +
                     " given; allowed: one of either, or none to release the patch");
  }
  if (!request.displacement.empty()) {
    const Vec3 displacement = toVec3(request.displacement.front());
    requireWithin(displacement, kFarthestPoint, "m", "displacement");
    if (request.turns) throw InputError("turns: true; allowed: only with a force");
    patch.displacement = {{displacement.x(), displacement.y(), displacement.z()}};
  } else {
    const Vec3 force = toVec3(request.force.front());
    requireWithin(force, kGreatestForce, "N", "force");
    patch.force = force;
    patch.turns = request.turns;
  }
  return patch;
}

}  // namespace

template <class Request, class Response>
ros::ServiceServer TissueServices::advertise(ros::NodeHandle& private_node, const std::string& name,
                                             bool (TissueServices::*answer)(Request&, Response&)) {
  const boost::function<bool(Request&, Response&)> wakes = [this, answer](Request& request,
                                                                          Response& response) {
    node_.wake();
    return (this->*answer)(request, response);
  };
  return private_node.advertiseService(name, wakes);
}

TissueServices::TissueServices(ros::NodeHandle& private_node, const NodeParameters& parameters,
                               Pipeline& pipeline, TissuePublisher& publisher,
                               const ToolPoses& tool_poses, Node node)
    : parameters_(parameters),
      pipeline_(pipeline),
      publisher_(publisher),
      tool_poses_(tool_poses),
      node_(std::move(node)) {
  reset_ = advertise(private_node, "reset", &TissueServices::onReset);
  cut_ = advertise(private_node, "cut", &TissueServices::onCut);
  load_ = advertise(private_node, "apply_load", &TissueServices::onApplyLoad);
  grasp_ = advertise(private_node, "grasp", &TissueServices::onGrasp);
  release_ = advertise(private_node, "release", &TissueServices::onRelease);
}

bool TissueServices::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  pipeline_.reset();
  node_.settle_from_rest();
  publisher_.shapeChanged();
  response.success = true;
  response.message =
      "rest shape, no cuts, no loads" + endOfAnswer(pipeline_.tissue().lastReport(), pipeline_);
  return true;
}

bool TissueServices::onCut(Cut::Request& request, Cut::Response& response) {
  try {
    const Pose tissue_T_blade = tool_poses_.frame(request.header);
    std::vector<Vec3> corners = cornersOf(request);
    for (Vec3& corner : corners) corner = tissue_T_blade * corner;
    const CutReport cut = pipeline_.cut(corners);
    publisher_.shapeChanged();
    response.success = true;
    response.springs_cut = cut.springs_cut;
    response.springs_torn = cut.springs_torn;
    response.pieces = cut.pieces;
    response.message = cut.springs_cut > 0 ? std::to_string(cut.springs_cut) + " springs cut"
                                           : "no spring crosses the polygon";
    if (cut.springs_torn > 0) {
      response.message += ", " + std::to_string(cut.springs_torn) + " torn thereafter";
    }
    response.message += endOfAnswer(cut.solve, pipeline_);
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
    response.pieces = pipeline_.tissue().state().pieces;
  }
  return true;
}

bool TissueServices::onApplyLoad(ApplyLoad::Request& request, ApplyLoad::Response& response) {
  try {
    requirePatchName(request.name);
    if (isTool(request.name)) {
      pushTool(request, response);
    } else {
      loadPatch(request, response);
    }
    response.success = true;
    publisher_.shapeChanged();
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

void TissueServices::loadPatch(const ApplyLoad::Request& request, ApplyLoad::Response& response) {
  for (const SupportConfig& support : parameters_.scene.supports) {
    if (support.name != request.name) continue;
    throw InputError("name: '" + request.name + "' is a support; allowed: another name");
  }
  if (request.displacement.empty() && request.force.empty()) {
    pipeline_.release({request.name});
    response.message = "released" + endOfAnswer(pipeline_.tissue().lastReport(), pipeline_);
    return;
  }
  requireBox(request);
  SolveReport last;
  LoadStep step;
  step.patches.push_back(patchOf(request));
  const auto keep = [&](int, int, const SolveReport& report) { last = report; };
  pipeline_.load(step, keep, tuning::kMostIncrements);
  const PatchAnswer answer = pipeline_.tissue().answerOf(request.name, last);
  response.force = toVector3(answer.force);
  response.displacement = toVector3(answer.displacement);
  const bool is_there = !pipeline_.tissue().isLoading();
  response.message = (is_there ? "loaded" : "on its way") + endOfAnswer(last, pipeline_);
}

}  // namespace robot_tissue
