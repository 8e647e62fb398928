#include "bag_follower.h"

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/UInt64.h>

#include <utility>

#include "robot_tissue/ros/periods.h"
#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/ros/shape_messages.h"
#include "robot_tissue/ros/tissue_messages.h"

namespace robot_tissue {
namespace {

const std::string kTopics = "/robot_tissue/";
// s of the bag without a message: after that nothing new is to be seen until the next one. More: a
// gap, as from zero to the wall's clock, takes longer and has more states. Chosen.
constexpr double kLongestWatch = 600.0;

}  // namespace

BagFollower::BagFollower(const NodeParameters& parameters, const std::vector<ToolGeometry>& tools,
                         Shape shape, OutputBag& out, std::function<void()> before_look)
    : parameters_(parameters),
      shape_(shape),
      out_(out),
      before_look_(std::move(before_look)),
      pipeline_(parameters.scene.tissue, parameters.scene.solver, tools, parameters.scene.supports),
      poses_(buffer_, parameters.scene.tissue.frame_id, parameters.tf_timeout_s),
      pick_(poses_, parameters.rate_hz),
      intake_(buffer_, [] { return false; }),
      follower_(parameters, pipeline_) {
  pipeline_.setMostIterations(parameters.scene.solver.max_iterations.value_or(0));
  poses_.setLinks(linkFrames(tools));
  for (const ToolGeometry& tool : tools) tool_frames_.push_back(linkFrames(tool).front());
  follower_.settleFromRest();
  connection_ = buffer_._addTransformsChangedListener([this] { onTransforms(); });
}

BagFollower::~BagFollower() { buffer_._removeTransformsChangedListener(connection_); }

void BagFollower::take(const tf2_msgs::TFMessage& message, TransformIntake::Kind kind,
                       const ros::Time& received) {
  watchUntil(received);
  ros::Time::setNow(received);
  intake_.take(message, kind);
}

// Where no pose comes the node's timer looks for what is wrong, or at links that are all static.
void BagFollower::watchUntil(const ros::Time& now) {
  const ros::Duration period(kWatchPeriod);
  if (next_watch_.isZero()) next_watch_ = now + period;
  const ros::Time start = next_watch_;
  for (; next_watch_ < now; next_watch_ += period) {
    before_look_();
    if (secondsBetween(start, next_watch_) > kLongestWatch) {
      next_watch_ = now;
      return;
    }
    ros::Time::setNow(next_watch_);
    if (!std::exchange(any_pose_, false)) update(poses_.lookUp(next_watch_), next_watch_);
  }
}

void BagFollower::onTransforms() {
  const ros::Time now = ros::Time::now();
  std::optional<PoseLookUp> look_up = pick_.take(now);
  if (!look_up) return;
  any_pose_ = true;
  update(std::move(*look_up), now);
}

void BagFollower::update(PoseLookUp look_up, const ros::Time& now) {
  if (look_up.status != PoseLookUp::Status::kOk) return tellFault(statusWithoutPose(look_up), now);
  try {
    const std::string waits = follower_.waitsAfterJump(look_up);
    if (!waits.empty()) return tellFault({"TOO_FAST", waits}, now);
    follower_.follow(look_up);
  } catch (const InputError& error) {
    return tellFault({"NO_TRANSFORM", error.what()}, now);
  }
  ++poses_followed_;
  status_ = statusOf(pipeline_, remarksOn(pipeline_));
  last_fault_ = ros::Time();
  tell(look_up);
}

// Wrenches and contacts only of a pose that the tissue reached.
void BagFollower::tell(const PoseLookUp& look_up) {
  const ros::Time& stamp = look_up.stamp;
  if (pipeline_.hasArrived()) {
    tellWrenches(stamp);
    ContactArray contacts = contactArray(pipeline_);
    contacts.header.stamp = stamp;
    contacts.header.frame_id = parameters_.scene.tissue.frame_id;
    out_.write(kTopics + "contacts", stamp, contacts);
  }
  tellState(stamp, look_up.age_s);
  std_msgs::UInt64 hash;
  hash.data = stateHash();
  out_.write(kTopics + "state_hash", stamp, hash);
  tellShape(stamp);
}

void BagFollower::tellWrenches(const ros::Time& stamp) {
  for (std::size_t tool = 0; tool < tool_frames_.size(); ++tool) {
    geometry_msgs::WrenchStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = tool_frames_[tool];
    message.wrench = wrenchOn(pipeline_.report().tools[tool]);
    out_.write(kTopics + pipeline_.tools()[tool].name + "/measured_cf", stamp, message);
  }
}

void BagFollower::tellShape(const ros::Time& stamp) {
  if (shape_is_told_ && !pipeline_.report().changed) return;
  shape_is_told_ = true;
  if (!shape_.surface && !shape_.nodes) return;
  const Tissue& tissue = pipeline_.tissue();
  const std::vector<int>& piece_of_node = tissue.pieceOfNodes();
  const std::string& frame = parameters_.scene.tissue.frame_id;
  if (shape_.surface) {
    Surface message;
    message.header.stamp = stamp;
    message.header.frame_id = frame;
    message.topology = static_cast<std::uint32_t>(tissue.surface().revision);
    setTriangles(tissue, piece_of_node, message);
    setVertices(tissue, message);
    out_.write(kTopics + "surface", stamp, message);
  }
  if (shape_.nodes) {
    sensor_msgs::PointCloud2 cloud = nodeCloud(tissue, piece_of_node);
    cloud.header.stamp = stamp;
    cloud.header.frame_id = frame;
    out_.write(kTopics + "nodes", stamp, cloud);
  }
}

// What hangs on the machine is left out: the time that things took.
void BagFollower::tellState(const ros::Time& stamp, double age_s) {
  TissueState message = stateMessage(pipeline_, status_);
  message.header.stamp = stamp;
  message.header.frame_id = parameters_.scene.tissue.frame_id;
  message.contact_ms = message.solve_ms = 0.0;
  message.pose_age_ms = 1e3 * age_s;
  out_.write(kTopics + "state", stamp, message);
}

// The last good shape stays.
void BagFollower::tellFault(const NodeStatus& status, const ros::Time& now) {
  const bool is_news = status.status != status_.status || last_fault_.isZero() ||
                       secondsBetween(last_fault_, now) >= kStatePeriod;
  status_ = status;
  if (!is_news) return;
  last_fault_ = now;
  tellState(now, 0.0);
}

}  // namespace robot_tissue
