#include "robot_tissue/ros/tissue_publisher.h"

#include <chrono>

#include "robot_tissue/ros/periods.h"
#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/ros/tissue_messages.h"
#include "tuning.h"

namespace robot_tissue {

TissuePublisher::TissuePublisher(ros::NodeHandle& private_node, const NodeParameters& parameters,
                                 const ToolPoses& poses)
    : private_node_(private_node),
      frame_id_(parameters.scene.tissue.frame_id),
      marker_builder_(frame_id_, {parameters.force_scale, parameters.color},
                      parameters.scene.supports),
      marker_pace_(parameters.marker_rate_hz),
      shape_(private_node_, frame_id_, parameters.marker_rate_hz),
      wrenches_(private_node_, poses, parameters.wrench_rate_hz) {
  const auto someone_came = [this](const ros::SingleSubscriberPublisher&) {
    marker_builder_.tellAll();
    shapeChanged();
  };
  markers_ = private_node_.advertise<visualization_msgs::MarkerArray>(
      "markers", tuning::kMarkerQueue, someone_came, ros::SubscriberStatusCallback(),
      ros::VoidConstPtr(), true);
  contacts_ = private_node_.advertise<ContactArray>("contacts", 1, someone_came);
  state_ = private_node_.advertise<TissueState>("state", 10);
}

void TissuePublisher::retune(const NodeParameters& parameters) {
  marker_builder_.setStyle({parameters.force_scale, parameters.color});
  marker_pace_ = UpdatePace(parameters.marker_rate_hz);
  shape_.setRate(parameters.marker_rate_hz);
  shapeChanged();
}

void TissuePublisher::publish(const Pipeline& pipeline, const ros::Time& stamp,
                              const NodeStatus& status) {
  const auto start = std::chrono::steady_clock::now();
  if (pipeline.report().changed) shapeChanged();
  if (status.message != last_status_.message) last_state_ = ros::Time();
  if (pipeline.hasArrived()) {
    wrenches_.publish(pipeline, stamp);
  } else {
    wrenches_.publishOld();
  }
  publishSeldom(pipeline, stamp, status);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  publish_ms_ = elapsed.count();
}

void TissuePublisher::publishSeldom(const Pipeline& pipeline, const ros::Time& stamp,
                                    const NodeStatus& status) {
  followTools(pipeline, stamp);
  pose_stamp_ = stamp;
  publishContacts(pipeline, stamp);
  publishMarkers(pipeline, stamp);
  shape_.publish(pipeline.tissue(), stamp);
  publishState(pipeline, stamp, status);
}

// Forces and edges change without the shape, too, as where a blade stops to cut.
void TissuePublisher::followTools(const Pipeline& pipeline, const ros::Time& stamp) {
  if (pipeline.hasArrived()) {
    const MarkerBuilder::News news = marker_builder_.reach(pipeline, stamp);
    if (news.any()) toolsChanged();
    contacts_due_ = contacts_due_ || news.forces;
    return;
  }
  const bool long_since = secondsBetween(marker_builder_.reachedAt(), stamp) > tuning::kOldForce;
  if (long_since && marker_builder_.fallBehind(pipeline)) toolsChanged();
}

void TissuePublisher::toolsChanged() {
  if (markers_due_ == MarkersDue::kNone) markers_due_ = MarkersDue::kTools;
}

void TissuePublisher::timeWentBack() {
  wrenches_.forget();
  marker_builder_.forgetTools();
  last_contacts_ = ros::Time();
  pose_stamp_ = ros::Time();
  shapeChanged();
}

bool TissuePublisher::isUpToDate() const {
  return !last_state_.isZero() && (!contacts_due_ || contacts_.getNumSubscribers() == 0) &&
         ((markers_due_ == MarkersDue::kNone && whole_array_is_out_) || !areMarkersWanted()) &&
         shape_.isUpToDate();
}

// The topic is latched: a first array goes out without a listener, for who comes later.
bool TissuePublisher::areMarkersWanted() const {
  return markers_.getNumSubscribers() > 0 || !latched_markers_are_out_;
}

void TissuePublisher::publishWithoutPose(const Pipeline& pipeline, const ros::Time& now,
                                         const NodeStatus& status, Wrenches wrenches) {
  wrenches == Wrenches::kOld ? wrenches_.publishOld() : wrenches_.fallSilent();
  if (marker_builder_.fallBehind(pipeline)) toolsChanged();
  publishMarkers(pipeline, now);  // of now, as rviz has no frame of long ago
  shape_.publish(pipeline.tissue(), pose_stamp_);
  publishState(pipeline, now, status);
}

// `time`: of the pose that is followed, else now; it says when the next one is due.
void TissuePublisher::publishState(const Pipeline& pipeline, const ros::Time& time,
                                   const NodeStatus& status) {
  const bool news = status.status != last_status_.status || last_state_.isZero() ||
                    secondsBetween(last_state_, time) >= kStatePeriod || time < last_state_;
  if (!news) return;
  last_status_ = status;
  last_state_ = time;
  if (state_.getNumSubscribers() == 0) return;
  TissueState message = stateNow(pipeline, status);
  message.publish_ms = publish_ms_;
  if (!pose_stamp_.isZero()) {
    message.pose_age_ms = 1e3 * secondsBetween(pose_stamp_, ros::Time::now());
  }
  state_.publish(message);
}

TissueState TissuePublisher::stateNow(const Pipeline& pipeline, const NodeStatus& status) const {
  TissueState message = stateMessage(pipeline, status);
  message.header.frame_id = frame_id_;
  message.header.stamp = pose_stamp_;
  return message;
}

void TissuePublisher::publishMarkers(const Pipeline& pipeline, const ros::Time& stamp) {
  const double now = ros::Time::now().toSec();
  const bool too_soon = !marker_pace_.isDue(now);
  const bool any_due = markers_due_ != MarkersDue::kNone || !whole_array_is_out_;
  if (!any_due || !areMarkersWanted() || too_soon) return;
  const bool whole = markers_due_ == MarkersDue::kNone || !latched_markers_are_out_;
  if (whole) marker_builder_.tellAll();
  const bool of_tools = !whole && markers_due_ == MarkersDue::kTools;
  const visualization_msgs::MarkerArray array = marker_builder_.buildChanged(
      pipeline, stamp, of_tools ? MarkerBuilder::What::kTools : MarkerBuilder::What::kAll);
  if (!array.markers.empty()) markers_.publish(array);
  whole_array_is_out_ = whole;
  latched_markers_are_out_ = true;
  markers_due_ = MarkersDue::kNone;
  marker_pace_.take(now);
}

void TissuePublisher::publishContacts(const Pipeline& pipeline, const ros::Time& stamp) {
  const bool due = contacts_due_ || secondsBetween(last_contacts_, stamp) >= kStatePeriod ||
                   stamp < last_contacts_;
  if (!due || contacts_.getNumSubscribers() == 0 || !pipeline.hasArrived()) return;
  contacts_due_ = false;
  last_contacts_ = stamp;
  ContactArray array = contactArray(pipeline);
  array.header.stamp = stamp;
  array.header.frame_id = frame_id_;
  contacts_.publish(array);
}

}  // namespace robot_tissue
