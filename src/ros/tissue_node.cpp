#include "robot_tissue/ros/tissue_node.h"

#include <ros/callback_queue.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"

namespace robot_tissue {
namespace {

const ros::WallDuration kRobotLookUpPeriod(1.0);
constexpr double kLongestUpdate = 0.1;  // s, without a budget of the solver
constexpr double kRateTolerance = 0.1;
constexpr double kWatchPeriod = 0.1;  // s, of the timer while nothing waits for it

}  // namespace

TissueNode::TissueNode(const ros::NodeHandle& private_node)
    : private_node_(private_node),
      parameters_(readNodeParameters(private_node_)),
      pipeline_(parameters_.scene.tissue, parameters_.scene.solver, {}, parameters_.scene.supports),
      tool_poses_(buffer_, parameters_.scene.tissue.frame_id, parameters_.tf_timeout_s),
      publisher_(private_node_, parameters_),
      lowest_rate_hz_(parameters_.rate_hz),
      highest_rate_hz_(parameters_.rate_hz),
      frequency_(diagnostic_updater::FrequencyStatusParam(&lowest_rate_hz_, &highest_rate_hz_,
                                                          kRateTolerance),
                 "update rate"),
      watch_(
          buffer_, tool_poses_, parameters_.rate_hz, *ros::getGlobalCallbackQueue(),
          [this](const ros::Time& stamp) { onStill(stamp); },
          [this](PoseLookUp look_up) { update(std::move(look_up)); }) {
  for (const std::string& remark : parameters_.scene.remarks) ROS_WARN_STREAM(remark);
  const double budget_ms = parameters_.scene.solver.max_ms;
  pipeline_.setBudget(budget_ms > 0.0 ? 1e-3 * budget_ms : kLongestUpdate);
  robotIsKnown();
  settleFromRest();
  advertiseServices();
  diagnostics_.setHardwareID("none");
  diagnostics_.add(frequency_);
  diagnostics_.add("transforms", this, &TissueNode::diagnoseTransforms);
  diagnostics_.add("solver", this, &TissueNode::diagnoseSolver);
  timer_ = private_node_.createTimer(ros::Duration(1.0 / parameters_.rate_hz),
                                     [this](const ros::TimerEvent&) { onTimer(); });
}

// In the thread that receives transforms.
void TissueNode::onStill(const ros::Time& stamp) {
  frequency_.tick();
  publisher_.publishStill(stamp);
}

void TissueNode::tick(bool seldom) {
  if (seldom == ticks_seldom_) return;
  ticks_seldom_ = seldom;
  const double period = 1.0 / parameters_.rate_hz;
  timer_.setPeriod(ros::Duration(seldom ? std::max(period, kWatchPeriod) : period));
}

void TissueNode::onTimer() {
  diagnostics_.update();
  if (!robotIsKnown()) {
    report({"NO_ROBOT", "parameter '" + parameters_.robot_description_param +
                            "' is not set: waiting for a URDF"});
    return tick(true);
  }
  const PoseWatch::Seen seen = watch_.seen();
  if (seen.still > last_look_up_.stamp) tellStill(seen.still);
  if (seen.any) return tick(true);
  watch_.standAt(std::nullopt);  // so that no later stamp is told before this one
  update(tool_poses_.lookUp(ros::Time::now()));
  const bool is_good = last_look_up_.status == PoseLookUp::Status::kOk;
  tick(!is_good || (isStill() && !publisher_.tellsWrenches()));
}

// What goes out seldom, at a pose at which nothing was to do.
void TissueNode::tellStill(const ros::Time& stamp) {
  last_look_up_.stamp = stamp;
  last_look_up_.age_s = (ros::Time::now() - stamp).toSec();
  publisher_.publishSeldom(pipeline_, stamp, status_);
}

// The next update at the same pose would do nothing but tell the wrenches again.
bool TissueNode::isStill() const {
  return !pipeline_.report().changed && pipeline_.stillPose() && publisher_.isUpToDate();
}

// Robot pose -> contacts -> loading patches -> solve (in Pipeline::step) -> publish.
void TissueNode::update(PoseLookUp look_up) {
  watch_.standAt(std::nullopt);
  frequency_.tick();
  last_look_up_ = std::move(look_up);
  if (last_look_up_.status != PoseLookUp::Status::kOk) {
    const bool stale = last_look_up_.status == PoseLookUp::Status::kStale;
    return report({stale ? "STALE" : "NO_TRANSFORM", last_look_up_.message});
  }
  try {
    follow();
  } catch (const InputError& error) {
    last_look_up_.status = PoseLookUp::Status::kNoTransform;
    last_look_up_.message = error.what();
    report({"NO_TRANSFORM", error.what()});
  }
}

// At a good pose.
void TissueNode::follow() {
  const StepReport& step = pipeline_.step(last_look_up_.pose);
  status_ = statusOf(step);
  if (step.too_fast || step.was_inside || step.torn_off) {
    ROS_WARN_STREAM_THROTTLE(1.0, status_.message);
  }
  publisher_.publish(pipeline_, last_look_up_.stamp, status_);
  if (isStill()) watch_.standAt(pipeline_.stillPose());
}

// What acts without tools: gravity and the supports.
void TissueNode::settleFromRest() {
  const Scene& scene = parameters_.scene;
  if (scene.tissue.gravity != Vec3::Zero() || !scene.supports.empty()) pipeline_.settle();
}

// Loads the tools once the robot's description is there; without tools none is needed.
bool TissueNode::robotIsKnown() {
  if (robot_is_known_) return true;
  const auto& tools = parameters_.scene.tools;
  if (!tools.empty()) {
    const ros::WallTime now = ros::WallTime::now();
    if (now < next_robot_look_up_) return false;
    next_robot_look_up_ = now + kRobotLookUpPeriod;
    std::string path, urdf;
    const std::string& name = parameters_.robot_description_param;
    if (!private_node_.searchParam(name, path) || !private_node_.getParam(path, urdf)) return false;
    const LoadedTools loaded = loadTools(urdf, tools);
    for (const std::string& warning : loaded.warnings) ROS_WARN_STREAM(warning);
    pipeline_.setTools(loaded.tools);
    for (const std::string& warning : pipeline_.toolWarnings()) ROS_WARN_STREAM(warning);
    publisher_.setTools(loaded.tools);
    std::vector<std::string> links;
    for (const ToolGeometry& tool : loaded.tools) {
      const std::vector<std::string> frames = linkFrames(tool);
      links.insert(links.end(), frames.begin(), frames.end());
    }
    tool_poses_.setLinks(links);
    watch_.start();
  }
  robot_is_known_ = true;
  return true;
}

// The last good shape stays; what is wrong is said.
void TissueNode::report(const NodeStatus& status) {
  if (status.status != status_.status) ROS_WARN_STREAM(status.status << ": " << status.message);
  status_ = status;
  publisher_.publishWithoutPose(pipeline_, ros::Time::now(), status_);
}

// The first word that applies; the message has all.
NodeStatus TissueNode::statusOf(const StepReport& report) const {
  NodeStatus status;
  const auto say = [&status](const std::string& word, const std::string& message) {
    if (status.status == "OK") status.status = word;
    status.message += (status.message.empty() ? "" : "; ") + message;
  };
  if (report.was_inside) {
    say("INSIDE", "a tool appeared inside the tissue and was walked in from outside");
  }
  if (report.torn_off) {
    say("TORN_OFF", "a grasper was pulled harder than it holds (grasp.max_force) and lost it");
  }
  if (report.too_fast) {
    say("TOO_FAST", "a tool moved further than could be followed in time: catching up");
  }
  if (report.lost) {
    say("UNCONVERGED",
        "no shape follows a tool, as between tools that meet: the last good one stays");
  }
  const SolveReport& solve = pipeline_.tissue().lastReport();
  if (report.late) {
    say("LATE", "the update ran out of its budget (solver.max_ms) and is carried on");
  } else if (solve.status == SolveStatus::kUnconverged) {
    say("UNCONVERGED", "a layer or patch did not come to balance");
  } else if (solve.status == SolveStatus::kInverted) {
    say("INVERTED", std::to_string(solve.inverted_cells) + " cells are inverted");
  }
  for (std::size_t tool = 0; tool < report.tools.size(); ++tool) {
    if (!report.tools[tool].jaws_overlap) continue;
    say("OK", "the jaws of '" + pipeline_.tools()[tool].name + "' touch or overlap");
  }
  return status;
}

void TissueNode::diagnoseTransforms(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!robot_is_known_) {
    status.summary(DiagnosticStatus::ERROR, "no robot description");
  } else if (last_look_up_.status == PoseLookUp::Status::kOk) {
    status.summary(DiagnosticStatus::OK, "fresh");
  } else {
    status.summary(DiagnosticStatus::ERROR, last_look_up_.message);
  }
  status.add("age of the pose (s)", last_look_up_.age_s);
}

void TissueNode::diagnoseSolver(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const SolveReport& solve = pipeline_.tissue().lastReport();
  const bool good = solve.status == SolveStatus::kOk;
  status.summary(good ? DiagnosticStatus::OK : DiagnosticStatus::WARN, toString(solve.status));
  status.add("solve (ms)", pipeline_.report().solve_ms);
  status.add("contact (ms)", pipeline_.report().contact_ms);
  status.add("residual", solve.residual);
  status.add("error estimate", solve.error_estimate);
  status.add("active nodes", solve.active_nodes);
}

}  // namespace robot_tissue
