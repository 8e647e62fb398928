#include "robot_tissue/ros/tissue_node.h"

#include <ros/callback_queue.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/pipeline/step_remarks.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

const ros::WallDuration kRobotLookUpPeriod(1.0);
const ros::WallDuration kGrace(2.0);        // after a start or a jump of time
const ros::WallDuration kClockPeriod(0.5);  // between looks for a clock

}  // namespace

TissueNode::TissueNode(const ros::NodeHandle& private_node)
    : private_node_(private_node),
      parameters_(readNodeParameters(private_node_)),
      pipeline_(parameters_.scene.tissue, parameters_.scene.solver, {}, parameters_.scene.supports),
      tool_poses_(buffer_, parameters_.scene.tissue.frame_id, parameters_.tf_timeout_s),
      publisher_(private_node_, parameters_, tool_poses_),
      clock_(1.0 / parameters_.rate_hz, tuning::kLongestGap),
      watch_(
          buffer_, tool_poses_, parameters_.rate_hz, *ros::getGlobalCallbackQueue(),
          [this](const ros::Time& stamp) { onStill(stamp); },
          [this](PoseLookUp look_up) { update(std::move(look_up)); }) {
  for (const std::string& remark : parameters_.scene.remarks) ROS_WARN_STREAM(remark);
  grace_end_ = ros::WallTime::now() + kGrace;
  pipeline_.setBudget(updateBudget(parameters_));
  robotIsKnown();
  settleFromRest();
  services_ = std::make_unique<TissueServices>(
      private_node_, parameters_, pipeline_, publisher_, tool_poses_,
      TissueServices::Node{[this] { watch_.standAt(std::nullopt); },
                           [this] { return last_look_up_.status == PoseLookUp::Status::kOk; },
                           [this] { follow(); }, [this] { settleFromRest(); }});
  surgery_ =
      std::make_unique<SurgeryServices>(private_node_, parameters_.state_dir, pipeline_, publisher_,
                                        tool_poses_, [this] { watch_.standAt(std::nullopt); });
  live_ = std::make_unique<LiveParameters>(
      private_node_, parameters_, [this](const NodeParameters& wanted) { retune(wanted); });
  diagnostics_.setHardwareIDf("%s %s: %d nodes", parameters_.scene.tissue.model.c_str(),
                              parameters_.scene.solver.method.c_str(),
                              pipeline_.tissue().lattice().nodeCount());
  rate_told_ = ros::WallTime::now();
  diagnostics_.add("update rate", this, &TissueNode::diagnoseRate);
  diagnostics_.add("transforms", this, &TissueNode::diagnoseTransforms);
  diagnostics_.add("tools", this, &TissueNode::diagnoseTools);
  diagnostics_.add("solver", this, &TissueNode::diagnoseSolver);
  timer_ = private_node_.createTimer(ros::Duration(1.0 / parameters_.rate_hz),
                                     [this](const ros::TimerEvent&) { onTimer(); });
  if (!ros::Time::isSimTime()) return;
  wall_timer_ = private_node_.createWallTimer(
      kClockPeriod, [this](const ros::WallTimerEvent&) { onWallTimer(); });
}

// In the thread that receives transforms.
void TissueNode::onStill(const ros::Time& stamp) { publisher_.publishStill(stamp); }

void TissueNode::tick(Ticks ticks) {
  if (ticks == ticks_) return;
  ticks_ = ticks;
  timer_.setPeriod(period());
}

// Of the timer.
ros::Duration TissueNode::period() const {
  const double at_rate = 1.0 / parameters_.rate_hz;
  return ros::Duration(ticks_ == Ticks::kSeldom ? std::max(at_rate, tuning::kWatchPeriod)
                                                : at_rate);
}

// Becomes what the parameters say, as far as LiveParameters changes them.
void TissueNode::retune(const NodeParameters& wanted) {
  const bool other_friction = frictionOf(wanted) != frictionOf(parameters_);
  parameters_ = wanted;
  watch_.standAt(std::nullopt);  // there may be something to do at the next pose
  watch_.setRate(parameters_.rate_hz);
  timer_.setPeriod(period());
  pipeline_.setBudget(updateBudget(parameters_));
  if (other_friction) pipeline_.setFriction(*frictionOf(parameters_));
  pipeline_.retune(parameters_.scene.tissue, parameters_.scene.solver);
  publisher_.retune(parameters_);
}

// Timers of simulated time stand still without a clock.
void TissueNode::onWallTimer() {
  if (!ros::Time::now().isZero()) return wall_timer_.stop();
  report({"NO_TRANSFORM", "use_sim_time is true, but nothing publishes a time on /clock"});
}

// Time is another one, as where a bag plays again: what was before says nothing of what is now. The
// tools are nowhere until their next pose. True: it went back since this was last asked.
bool TissueNode::timeWentBack() {
  const int jumps = watch_.timeJumps();
  if (jumps == time_jumps_) return false;
  ROS_WARN_STREAM_COND(time_jumps_ == 0,
                       "time went back, as where a bag plays again or a simulation is reset: the "
                       "shape stays, the tools come in anew (said once)");
  time_jumps_ = jumps;
  grace_end_ = ros::WallTime::now() + kGrace;
  jumped_at_ = ros::Time();
  last_look_up_ = PoseLookUp();
  if (robot_is_known_) {
    RobotPose nowhere;
    nowhere.stamp_s = clock_.now();
    pipeline_.step(nowhere);
  }
  publisher_.timeWentBack();
  diagnostics_.force_update();  // it would wait for the time of before
  return true;
}

void TissueNode::onTimer() {
  diagnostics_.update();
  timeWentBack();
  if (!robotIsKnown()) {
    report({"NO_ROBOT", "parameter '" + parameters_.robot_description_param +
                            "' is not set: waiting for a URDF"});
    return tick(pipeline_.isLate() ? Ticks::kAtRate : Ticks::kSeldom);
  }
  const PoseWatch::Seen seen = watch_.seen();
  if (seen.still > last_look_up_.stamp) tellStill(seen.still);
  if (seen.any) return tick(Ticks::kSeldom);
  watch_.standAt(std::nullopt);  // so that no later stamp is told before this one
  update(tool_poses_.lookUp(ros::Time::now()));
  const bool is_good = last_look_up_.status == PoseLookUp::Status::kOk;
  const bool has_time = !is_good || (isStill() && !publisher_.tellsWrenches());
  tick(has_time && !pipeline_.isLate() ? Ticks::kSeldom : Ticks::kAtRate);
}

// Publishes markers and state, which go out seldom, at a pose at which there was nothing to solve.
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
  if (timeWentBack()) return;  // the pose may be one of before
  last_look_up_ = std::move(look_up);
  if (last_look_up_.status != PoseLookUp::Status::kOk) {
    const bool stale = last_look_up_.status == PoseLookUp::Status::kStale;
    return report({stale ? "STALE" : "NO_TRANSFORM", last_look_up_.message});
  }
  try {
    if (waitsAfterJump()) return;
    follow();
  } catch (const InputError& error) {
    last_look_up_.status = PoseLookUp::Status::kNoTransform;
    last_look_up_.message = error.what();
    report({"NO_TRANSFORM", error.what()});
  }
}

// A pose that a tool jumped to may be a wrong one: while tools touch, it has to last before the
// good shape is given up for it.
bool TissueNode::waitsAfterJump() {
  const auto jumped = pipeline_.tissue().isUntouched() ? std::vector<std::size_t>()
                                                       : pipeline_.jumpsTo(last_look_up_.pose);
  const ros::Time now = last_look_up_.stamp;
  if (jumped.empty() || now < jumped_at_) jumped_at_ = ros::Time();
  if (jumped.empty()) return false;
  if (jumped_at_.isZero()) jumped_at_ = now;
  if ((now - jumped_at_).toSec() >= parameters_.tf_timeout_s) return false;
  last_look_up_.status = PoseLookUp::Status::kStale;
  last_look_up_.message = namesOf(jumped, pipeline_.tools()) +
                          " jumped, farther than is followed: the last good shape stays, until "
                          "the pose has lasted for " +
                          numberText(parameters_.tf_timeout_s) + " s (~tf_timeout)";
  report({"TOO_FAST", last_look_up_.message});
  return true;
}

// The pose's time is the tissue's.
void TissueNode::setTimeOf(RobotPose& pose) {
  pose.stamp_s = clock_.advance(last_look_up_.stamp, pipeline_.tissue().isMoving());
  if (clock_.leftOut() > 0.0) {
    ROS_WARN_STREAM_THROTTLE(1.0, "no pose came for a while: for "
                                      << clock_.leftOut()
                                      << " s of it the tissue's time stood still");
  }
}

// At a good pose.
void TissueNode::follow() {
  setTimeOf(last_look_up_.pose);
  const StepReport& step = pipeline_.step(last_look_up_.pose);
  if (timeWentBack()) return;
  warned_.clear();
  status_ = statusOf(step);
  const bool comes_anew = time_jumps_ > 0 && ros::WallTime::now() < grace_end_;
  if (!comes_anew && (step.too_fast || !step.were_inside.empty() || !step.torn_off.empty())) {
    ROS_WARN_STREAM_THROTTLE(1.0, status_.message);
  }
  publisher_.publish(pipeline_, last_look_up_.stamp, status_);
  if (isStill() && pipeline_.hasArrived()) watch_.standAt(pipeline_.stillPose());
}

// Balances the tissue under what acts without tools: gravity and the supports.
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

// The last good shape stays; what is wrong is said, but for what is so at every start.
void TissueNode::report(const NodeStatus& status) {
  if (status.status != warned_ && ros::WallTime::now() >= grace_end_) {
    ROS_WARN_STREAM(status.status << ": " << status.message);
    warned_ = status.status;
  }
  status_ = status;
  if (pipeline_.isLate()) {
    pipeline_.carryOn();
    publisher_.shapeChanged();
  }
  publisher_.publishWithoutPose(pipeline_, ros::Time::now(), status_);
}

}  // namespace robot_tissue
