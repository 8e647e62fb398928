#include "robot_tissue/ros/tissue_node.h"

#include <ros/callback_queue.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/ros/periods.h"
#include "robot_tissue/ros/robot_description.h"
#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/scene/memory.h"
#include "settling_notice.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

const ros::WallDuration kRobotLookUpPeriod(1.0);
const ros::WallDuration kGrace(2.0);        // after a start or a jump of time
const ros::WallDuration kClockPeriod(0.5);  // between looks at a clock that is told
const ros::WallDuration kTidyPeriod(1.0);   // at least, between two times that memory is given back

}  // namespace

TissueNode::TissueNode(const ros::NodeHandle& private_node)
    : private_node_(private_node),
      parameters_(readNodeParameters(private_node_)),
      pipeline_(parameters_.scene.tissue, parameters_.scene.solver, {}, parameters_.scene.supports),
      tool_poses_(buffer_, parameters_.scene.tissue.frame_id, parameters_.tf_timeout_s),
      publisher_(private_node_, parameters_, tool_poses_),
      follower_(parameters_, pipeline_),
      watch_(
          buffer_, tool_poses_, parameters_.rate_hz, *ros::getGlobalCallbackQueue(),
          [this](const ros::Time& stamp) { onStill(stamp); },
          [this](PoseLookUp look_up) { update(std::move(look_up)); }) {
  for (const std::string& remark : parameters_.scene.remarks) ROS_WARN_STREAM(remark);
  grace_end_ = ros::SteadyTime::now() + kGrace;
  pipeline_.setBudget(updateBudget(parameters_));
  pipeline_.setMostIterations(mostIterations(parameters_));
  pipeline_.leaveDepths();
  pipeline_.setEnd(Deadline(std::numeric_limits<double>::infinity(), ros::isShuttingDown));
  robotIsKnown();
  services_ = std::make_unique<TissueServices>(
      private_node_, parameters_, pipeline_, publisher_, tool_poses_,
      TissueServices::Node{[this] { wake(); },
                           [this] { return last_look_up_.status == PoseLookUp::Status::kOk; },
                           [this] { follow(); }, [this] { settleFromRest(); }});
  surgery_ = std::make_unique<SurgeryServices>(private_node_, parameters_.state_dir, pipeline_,
                                               publisher_, tool_poses_, [this] { wake(); });
  live_ = std::make_unique<LiveParameters>(
      private_node_, parameters_, [this](const NodeParameters& wanted) { retune(wanted); });
  addDiagnostics();
  timer_ = private_node_.createTimer(period(), [this](const ros::TimerEvent&) { onTimer(); });
  if (ros::Time::isSimTime()) {
    steady_timer_ = private_node_.createSteadyTimer(
        kClockPeriod, [this](const ros::SteadyTimerEvent&) { onSteadyTimer(); });
  }
  settleFromRest();  // the last, as it may take long: services are there, and answer after it
}

// What has to come to lie takes seconds; what does not, an update at most.
void TissueNode::settleFromRest() {
  if (!pipeline_.isLoose()) return follower_.settleFromRest();
  const std::string settles = "the tissue settles on its supports; all else waits until it lies";
  ROS_INFO_STREAM(settles);
  const ros::SteadyTime start = ros::SteadyTime::now();
  {
    const SettlingNotice notice(publisher_, diagnostics_,
                                publisher_.stateNow(pipeline_, {"SETTLING", settles}));
    follower_.settleFromRest();
  }
  grace_end_ = ros::SteadyTime::now() + kGrace;
  if (ros::isShuttingDown()) return;
  ROS_INFO_STREAM("the tissue has settled, in "
                  << (ros::SteadyTime::now() - start).toSec() << " s"
                  << endOfAnswer(pipeline_.tissue().lastReport(), pipeline_));
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
  return ros::Duration(ticks_ == Ticks::kSeldom ? kWatchPeriod : std::min(at_rate, kWatchPeriod));
}

// Becomes what the parameters say, as far as LiveParameters changes them.
void TissueNode::retune(const NodeParameters& wanted) {
  const bool other_friction = frictionOf(wanted) != frictionOf(parameters_);
  parameters_ = wanted;
  watch_.standAt(std::nullopt);  // there may be something to do at the next pose
  publisher_.tissueIsToChange();
  watch_.setRate(parameters_.rate_hz);
  timer_.setPeriod(period());
  pipeline_.setBudget(updateBudget(parameters_));
  pipeline_.setMostIterations(mostIterations(parameters_));
  if (other_friction) pipeline_.setFriction(*frictionOf(parameters_));
  pipeline_.retune(parameters_.scene.tissue, parameters_.scene.solver);
  publisher_.retune(parameters_);
}

// Before a request, which may give something to do at the pose that the node has: from here on none
// is still, and that pose is as new as the still ones answered so far, so that no stamp goes back.
void TissueNode::wake() {
  watch_.standAt(std::nullopt);
  publisher_.tissueIsToChange();
  const ros::Time still = watch_.newestStill();
  if (still > last_look_up_.stamp) standUntil(still);
}

// Timers of simulated time stand still without a clock, and where time goes back one whose period
// was set since it last came may sleep until it is as late as before.
void TissueNode::onSteadyTimer() {
  if (ros::Time::now().isZero()) {
    return report({"NO_TRANSFORM", "use_sim_time is true, but nothing publishes a time on /clock"});
  }
  timeWentBack();
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
  timer_.setPeriod(period());  // it comes again from now on
  grace_end_ = ros::SteadyTime::now() + kGrace;
  last_look_up_ = PoseLookUp();
  if (robot_is_known_) follower_.timeWentBack();
  publisher_.timeWentBack();
  diagnostics_.force_update();  // it would wait for the time of before
  return true;
}

void TissueNode::onTimer() {
  diagnostics_.update();
  giveBackMemory();
  timeWentBack();
  if (!robotIsKnown()) {
    const std::string link = linkThatNeedsUrdf(parameters_.scene.tools).value_or("");
    report({"NO_ROBOT", "parameter '" + parameters_.robot_description_param +
                            "' is not set: waiting for a URDF, as link '" + link +
                            "' has no shapes in the scene"});
    return tick(pipeline_.isLate() ? Ticks::kAtRate : Ticks::kSeldom);
  }
  const PoseWatch::Seen seen = watch_.seen();
  if (seen.still > last_look_up_.stamp) tellStill(seen.still);
  if (seen.any) return tick(Ticks::kSeldom);
  watch_.standAt(std::nullopt);  // so that no later stamp is told before this one
  PoseLookUp look_up = tool_poses_.lookUp(ros::Time::now());
  const bool goes_on =
      look_up.status == PoseLookUp::Status::kOk && last_look_up_.status == PoseLookUp::Status::kOk;
  if (goes_on && !watch_.takeTurn()) {
    if (pipeline_.isLate()) update(PoseLookUp(last_look_up_));  // what is left of the last update
    return;
  }
  update(std::move(look_up));
  const bool is_good = last_look_up_.status == PoseLookUp::Status::kOk;
  const bool has_time = !is_good || (isStill() && !publisher_.tellsWrenches());
  tick(has_time && !pipeline_.isLate() ? Ticks::kSeldom : Ticks::kAtRate);
}

// The pose that was looked up last is the tools' at this time, too.
void TissueNode::standUntil(const ros::Time& stamp) {
  last_look_up_.stamp = stamp;
  last_look_up_.age_s = secondsBetween(stamp, ros::Time::now());
}

// Publishes markers and state, which go out seldom, at a pose at which there was nothing to solve.
void TissueNode::tellStill(const ros::Time& stamp) {
  standUntil(stamp);
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
    const std::string refused = watch_.refusedTransform();
    if (!refused.empty()) last_look_up_.message += "; " + refused;
    return report(statusWithoutPose(last_look_up_));
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

bool TissueNode::waitsAfterJump() {
  const std::string waits = follower_.waitsAfterJump(last_look_up_);
  if (waits.empty()) return false;
  last_look_up_.status = PoseLookUp::Status::kStale;
  last_look_up_.message = waits;
  report({"TOO_FAST", waits}, TissuePublisher::Wrenches::kOld);
  return true;
}

// At a good pose.
void TissueNode::follow() {
  const StepReport& step = follower_.follow(last_look_up_);
  if (timeWentBack()) return;
  warned_.clear();
  const std::vector<StepRemark> remarks = remarksOn(pipeline_);
  status_ = statusOf(pipeline_, remarks);
  remember(remarks);
  const bool comes_anew = time_jumps_ > 0 && ros::SteadyTime::now() < grace_end_;
  if (!comes_anew &&
      (step.too_fast || step.lost || !step.were_inside.empty() || !step.hooked.empty() ||
       !step.jammed.empty() || !step.torn_off.empty() || !step.torn_out.empty())) {
    ROS_WARN_STREAM_THROTTLE(1.0, status_.message);
  }
  publisher_.publish(pipeline_, last_look_up_.stamp, status_);
  if (isStill() && pipeline_.hasArrived()) watch_.standAt(pipeline_.stillPose());
}

// Loads the tools once the robot's description is there; where all shapes are the scene's own none
// is needed.
bool TissueNode::robotIsKnown() {
  if (robot_is_known_) return true;
  const auto& tools = parameters_.scene.tools;
  if (!tools.empty()) {
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (now < next_robot_look_up_) return false;
    next_robot_look_up_ = now + kRobotLookUpPeriod;
    const auto urdf = robotDescription(private_node_, parameters_.robot_description_param);
    if (!urdf && linkThatNeedsUrdf(tools)) return false;
    const LoadedTools loaded = urdf ? loadTools(*urdf, tools) : toolsOf(tools);
    for (const std::string& warning : loaded.warnings) ROS_WARN_STREAM(warning);
    pipeline_.setTools(loaded.tools);
    for (const std::string& warning : pipeline_.toolWarnings()) ROS_WARN_STREAM(warning);
    publisher_.setTools(loaded.tools);
    tool_poses_.setLinks(linkFrames(loaded.tools));
    watch_.start();
  }
  robot_is_known_ = true;
  return true;
}

// Where the topology changed, cells, surface and levels were made anew among what stayed: without
// this the heap grows by the gaps for hours.
void TissueNode::giveBackMemory() {
  const std::uint64_t revision = pipeline_.tissue().surface().revision;
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (revision == tidy_revision_ || now - tidied_ < kTidyPeriod) return;
  giveBackFreeMemory();
  tidy_revision_ = revision;
  tidied_ = now;
}

// The last good shape stays; what is wrong is said, but for what is so at every start.
void TissueNode::report(const NodeStatus& status, TissuePublisher::Wrenches wrenches) {
  if (status.status != warned_ && ros::SteadyTime::now() >= grace_end_) {
    ROS_WARN_STREAM(status.status << ": " << status.message);
    warned_ = status.status;
  }
  status_ = status;
  if (pipeline_.isLate()) {
    pipeline_.carryOn();
    publisher_.shapeChanged();
  }
  publisher_.stoodUntil(watch_.newestStill());
  publisher_.publishWithoutPose(pipeline_, ros::Time::now(), status_, wrenches);
}

}  // namespace robot_tissue
