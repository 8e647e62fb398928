// Everything the node publishes, in one place. Markers go out only when they changed and somebody
// listens, at most at their own rate: those that changed, and all of them when somebody came and
// when the shape has come to rest, so that the latched array is whole and nothing that a slow
// listener lost stays lost. Contacts go out when they changed, and as often as the state. While the
// tissue is behind the tools, wrenches and contacts are those of the last pose that it reached; so
// are the forces in the markers, dimmed.
#pragma once

#include <robot_tissue/TissueState.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <algorithm>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/markers.h"
#include "robot_tissue/ros/node_parameters.h"
#include "robot_tissue/ros/node_status.h"
#include "robot_tissue/ros/shape_publisher.h"
#include "robot_tissue/ros/update_pace.h"
#include "robot_tissue/ros/wrench_publisher.h"

namespace robot_tissue {

class TissuePublisher {
 public:
  // The poses must outlive it.
  TissuePublisher(ros::NodeHandle& private_node, const NodeParameters& parameters,
                  const ToolPoses& poses);

  // Two wrench topics a tool.
  void setTools(const std::vector<ToolGeometry>& tools) { wrenches_.setTools(tools); }

  // By something else than the tools, as a service's request.
  void tissueIsToChange() { wrenches_.tissueIsToChange(); }

  // Takes the markers' rate and the scale of forces; all is published anew.
  void retune(const NodeParameters& parameters);

  // After an update at a good pose. `stamp` is the pose's.
  void publish(const Pipeline& pipeline, const ros::Time& stamp, const NodeStatus& status);
  // At a pose at which nothing was to do; in any thread. What else is due then waits for
  // publishSeldom.
  void publishStill(const ros::Time& stamp) { wrenches_.publishAgain(stamp); }
  void publishSeldom(const Pipeline& pipeline, const ros::Time& stamp, const NodeStatus& status);
  // That was still so at this pose, told as still or not yet.
  void stoodUntil(const ros::Time& stamp) { pose_stamp_ = std::max(pose_stamp_, stamp); }
  // Forgets the stamps told so far, as time went back, and publishes the shape anew.
  void timeWentBack();
  // Nothing but what goes out once a second and at every pose is to be published.
  bool isUpToDate() const;
  bool tellsWrenches() const { return wrenches_.isListenedTo(); }
  // When there is no good pose: what is wrong, with the last good shape. kOld: the wrenches are
  // told on, with the stamp of the pose that they belong to.
  enum class Wrenches { kNone, kOld };
  void publishWithoutPose(const Pipeline& pipeline, const ros::Time& now, const NodeStatus& status,
                          Wrenches wrenches);

  // Without times.
  TissueState stateNow(const Pipeline& pipeline, const NodeStatus& status) const;
  // Of what is done in place of updates; in any thread.
  void tell(const TissueState& state) const { state_.publish(state); }

  // The next call sends markers and state, whatever their period.
  void shapeChanged() {
    markers_due_ = MarkersDue::kAll;
    contacts_due_ = true;
    shape_.shapeChanged();
    last_state_ = ros::Time();
  }

 private:
  enum class MarkersDue { kNone, kTools, kAll };  // kTools: those of the tools alone

  void followTools(const Pipeline& pipeline, const ros::Time& stamp);
  void toolsChanged();
  bool areMarkersWanted() const;
  void publishMarkers(const Pipeline& pipeline, const ros::Time& stamp);
  void publishContacts(const Pipeline& pipeline, const ros::Time& stamp);
  void publishState(const Pipeline& pipeline, const ros::Time& time, const NodeStatus& status);

  ros::NodeHandle private_node_;
  std::string frame_id_;
  MarkerBuilder marker_builder_;
  UpdatePace marker_pace_;
  MarkersDue markers_due_ = MarkersDue::kAll;
  bool whole_array_is_out_ = false;  // with nothing changed since
  bool contacts_due_ = true;
  ros::Time last_contacts_;
  bool latched_markers_are_out_ = false;
  ros::Time pose_stamp_;  // of the last good pose; zero before there was one
  NodeStatus last_status_;
  ros::Time last_state_;
  double publish_ms_ = 0.0;
  ros::Publisher markers_, contacts_, state_;
  ShapePublisher shape_;
  WrenchPublisher wrenches_;
};

}  // namespace robot_tissue
