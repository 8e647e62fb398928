// How old the pose is when the wrenches come that were solved for it. Moves links that stand fast
// in one another, as a hand's, into the node's block, round on it and out, again and again, and
// listens to the wrenches, the state and the markers of the node /robot_tissue. For scripts/study
// node.
//   pose_age SECONDS RATE SPEED LINK X Y Z [LINK X Y Z ...]
//     RATE     poses a second
//     SPEED    m/s
//     X, Y, Z  m: of the link's origin off the middle of the way, and over the link's lowest point
// Writes one line a pose: phase (press, drag, draw), age_ms (from its stamp to when the last of its
// wrenches was received; empty: none came), contact_ms, solve_ms, publish_ms, told_age_ms, status
// (as the node's state tells; empty: it told none of that pose).
#include <geometry_msgs/WrenchStamped.h>
#include <robot_tissue/TissueState.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr double kMiddle = 0.05, kTop = 0.05;     // m, of the block
constexpr double kPress = 0.005, kRound = 0.010;  // m: depth, and radius of the way
constexpr double kGap = 0.001;                    // m: between block and links, when they are out
constexpr double kDown = kPress + kGap;           // m
constexpr double kDrag = 2.0 * M_PI * kRound;     // m: once round
constexpr double kTurn =
    kDown + kDrag + kDown + kGap;    // m: until it begins anew, with a rest above
constexpr double kStart = 1.0;       // s: of poses that stand, before the first turn
const ros::WallDuration kLast(0.5);  // that wrenches may still come

struct Link {
  std::string name;
  double x, y, z;
};

struct Place {
  const char* phase;
  double x, y, z;  // m
};

// After so much way of the links together.
Place placeAfter(double way) {
  const double gone = std::fmod(way, kTurn);
  const double round = std::min(std::max(gone - kDown, 0.0), kDrag);
  const double out = std::min(std::max(gone - kDown - kDrag, 0.0), kDown);
  const double angle = round / kRound;
  const char* phase = gone <= kDown ? "press" : gone <= kDown + kDrag ? "drag" : "draw";
  return {phase, kMiddle + kRound * std::cos(angle), kMiddle + kRound * std::sin(angle),
          kTop + kGap - std::min(gone, kDown) + out};
}

struct Seen {
  std::string phase;
  int wrenches = 0;
  double age_ms = 0.0;
  bool is_told = false;
  robot_tissue::TissueState state;
};

class PoseAge {
 public:
  PoseAge(std::vector<Link> links, double rate_hz, double speed)
      : links_(std::move(links)), rate_hz_(rate_hz), speed_(speed) {
    transforms_ = node_.advertise<tf2_msgs::TFMessage>("/tf", 10);
    const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
    for (const Link& link : links_) {
      listeners_.push_back(node_.subscribe("/robot_tissue/" + link.name + "/measured_cf", 100,
                                           &PoseAge::onWrench, this, at_once));
    }
    listeners_.push_back(
        node_.subscribe("/robot_tissue/state", 100, &PoseAge::onState, this, at_once));
    listeners_.push_back(
        node_.subscribe("/robot_tissue/markers", 1, &PoseAge::onMarkers, this, at_once));
  }

  // Poses that stand above the tissue, until the node follows them, and then those of the way.
  void run(double seconds) {
    while (ros::ok() && !isFollowed()) move(0.1, 0.0);
    move(kStart, 0.0);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      seen_.clear();
    }
    move(seconds, speed_);
    kLast.sleep();
  }

  void write() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::puts("phase,age_ms,contact_ms,solve_ms,publish_ms,told_age_ms,status");
    for (const auto& [stamp, seen] : seen_) {
      std::printf("%s,", seen.phase.c_str());
      if (seen.wrenches == static_cast<int>(links_.size())) std::printf("%.4f", seen.age_ms);
      if (seen.is_told) {
        std::printf(",%.4f,%.4f,%.4f,%.4f,%s\n", seen.state.contact_ms, seen.state.solve_ms,
                    seen.state.publish_ms, seen.state.pose_age_ms, seen.state.status.c_str());
      } else {
        std::puts(",,,,,");
      }
    }
  }

 private:
  bool isFollowed() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::any_of(seen_.begin(), seen_.end(),
                       [](const auto& pose) { return pose.second.wrenches > 0; });
  }

  void move(double seconds, double speed) {
    const auto start = std::chrono::steady_clock::now();
    const int count = static_cast<int>(seconds * rate_hz_);
    for (int sent = 0; sent < count && ros::ok(); ++sent) {
      send(placeAfter(sent * speed / rate_hz_));
      std::this_thread::sleep_until(start + std::chrono::duration<double>((sent + 1) / rate_hz_));
    }
  }

  void send(const Place& place) {
    tf2_msgs::TFMessage message;
    for (const Link& link : links_) {
      geometry_msgs::TransformStamped transform;
      transform.header.frame_id = "tissue";
      transform.child_frame_id = link.name;
      transform.transform.translation.x = place.x + link.x;
      transform.transform.translation.y = place.y + link.y;
      transform.transform.translation.z = place.z + link.z;
      transform.transform.rotation.w = 1.0;
      message.transforms.push_back(transform);
    }
    const ros::Time now = ros::Time::now();
    for (auto& transform : message.transforms) transform.header.stamp = now;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      seen_[now].phase = place.phase;
    }
    transforms_.publish(message);
  }

  // When a message was received is told by the thread that did.
  void onWrench(const ros::MessageEvent<geometry_msgs::WrenchStamped const>& event) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = seen_.find(event.getMessage()->header.stamp);
    if (found == seen_.end()) return;
    Seen& seen = found->second;
    if (seen.wrenches == static_cast<int>(links_.size())) return;  // told again
    ++seen.wrenches;
    seen.age_ms = 1e3 * (event.getReceiptTime() - found->first).toSec();
  }

  void onState(const robot_tissue::TissueState& state) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = seen_.find(state.header.stamp);
    if (found == seen_.end()) return;
    found->second.is_told = true;
    found->second.state = state;
  }

  // Nobody builds markers for nobody.
  void onMarkers(const visualization_msgs::MarkerArray&) {}

  ros::NodeHandle node_;
  std::vector<Link> links_;
  double rate_hz_, speed_;
  ros::Publisher transforms_;
  std::vector<ros::Subscriber> listeners_;
  std::mutex mutex_;  // of the poses
  std::map<ros::Time, Seen> seen_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "pose_age");
  if (argc < 8 || argc % 4 != 0) {
    ROS_FATAL("usage: pose_age SECONDS RATE SPEED LINK X Y Z [LINK X Y Z ...]");
    return 2;
  }
  std::vector<Link> links;
  for (int word = 4; word < argc; word += 4) {
    links.push_back({argv[word], std::stod(argv[word + 1]), std::stod(argv[word + 2]),
                     std::stod(argv[word + 3])});
  }
  PoseAge measured(links, std::stod(argv[2]), std::stod(argv[3]));
  ros::AsyncSpinner receiving(1);
  receiving.start();
  measured.run(std::stod(argv[1]));
  measured.write();
  return 0;
}
