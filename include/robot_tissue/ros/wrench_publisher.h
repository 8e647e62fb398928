// The wrench of the tissue on each tool, in the tool's frame, about its origin (N, N m).
//
// With a rate of its own a thread sends the last wrench solved again and again, so that the rate
// stays while a solve takes long; the stamp is that of the pose that was solved. Beside it, on a
// topic of its own, what the contact's stiffness makes of it at the tool's newest pose
// (WrenchPrediction), with that pose's stamp. Where the tissue is too far behind for that, that
// topic has what was solved, once and with its own stamp, and is silent in between: a control loop
// is told by its last stamp, and by the silence, that it has no force of now. While nobody listens
// it sleeps.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/pipeline/wrench_prediction.h"
#include "robot_tissue/ros/tool_poses.h"

namespace robot_tissue {

class WrenchPublisher {
 public:
  // rate_hz 0: once an update. The poses must outlive it.
  WrenchPublisher(const ros::NodeHandle& private_node, const ToolPoses& poses, double rate_hz);
  ~WrenchPublisher();
  WrenchPublisher(const WrenchPublisher&) = delete;
  WrenchPublisher& operator=(const WrenchPublisher&) = delete;

  // Two topics a tool.
  void setTools(const std::vector<ToolGeometry>& tools);
  // After an update at a good pose. `stamp` is the pose's.
  void publish(const Pipeline& pipeline, const ros::Time& stamp);
  // The last ones hold at this pose as well. In any thread.
  void publishAgain(const ros::Time& stamp);
  // The tissue is behind the tools: the last ones are told as they were, with the stamp of the pose
  // that they belong to.
  void publishOld();
  // No good pose: nothing is sent until there is one again.
  void fallSilent();
  // Forgets the wrenches told so far, as time went back: they are not told again.
  void forget();
  // By something else than the tools: the next wrench tells nothing of how it follows them.
  void tissueIsToChange();
  bool isListenedTo() const;

 private:
  // The topics of one tool, and the wrench last told on them.
  struct Told {
    ros::Publisher solved, predicted;  // do not change while the thread runs
    geometry_msgs::WrenchStamped message;
    std::size_t first_link = 0;
    WrenchPrediction prediction;
    ros::Time predicted_until;  // the newest stamp told of `predicted`: none goes back
  };

  void repeat();
  void send();
  void sendPredicted();
  static void sendPredicted(Told& told, const ToolPoses::Newest& newest);
  void stop();

  ros::NodeHandle private_node_;
  const ToolPoses& poses_;
  double rate_hz_;
  std::mutex mutex_;  // of the members up to the thread
  std::vector<Told> tools_;
  bool silent_ = true;
  bool has_told_ = false;
  bool stops_ = false;
  std::condition_variable changed_;  // a listener came, or the thread is to stop
  std::thread thread_;
};

}  // namespace robot_tissue
