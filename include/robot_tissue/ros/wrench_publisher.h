// The wrench of the tissue on each tool, in the tool's frame, about its origin (N, N m).
//
// With a rate of its own a thread sends the last wrench solved again and again, so that the rate
// stays while a solve takes long; the stamp is that of the pose that was solved. While nobody
// listens it sleeps.
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

namespace robot_tissue {

class WrenchPublisher {
 public:
  // rate_hz 0: once an update.
  WrenchPublisher(const ros::NodeHandle& private_node, double rate_hz);
  ~WrenchPublisher();
  WrenchPublisher(const WrenchPublisher&) = delete;
  WrenchPublisher& operator=(const WrenchPublisher&) = delete;

  // One topic a tool.
  void setTools(const std::vector<ToolGeometry>& tools);
  // After an update at a good pose; one report a tool. `stamp` is the pose's.
  void publish(const std::vector<ToolReport>& reports, const ros::Time& stamp);
  // The last ones hold at this pose as well. In any thread.
  void publishAgain(const ros::Time& stamp);
  // The tissue is behind the tools: the last ones are told as they were, with the stamp of the pose
  // that they belong to.
  void publishOld();
  // No good pose: nothing is sent until there is one again.
  void fallSilent();
  // Those told so far are of another time: they are not told again.
  void forget();
  bool isListenedTo() const;

 private:
  void repeat();
  void send();
  void stop();

  ros::NodeHandle private_node_;
  double rate_hz_;
  std::vector<ros::Publisher> publishers_;  // do not change while the thread runs
  std::mutex mutex_;                        // of the members up to the thread
  std::vector<geometry_msgs::WrenchStamped> messages_;
  bool silent_ = true;
  bool has_told_ = false;
  bool stops_ = false;
  std::condition_variable listener_came_;  // or the thread is to stop
  std::thread thread_;
};

}  // namespace robot_tissue
