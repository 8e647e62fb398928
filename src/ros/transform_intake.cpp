#include "robot_tissue/ros/transform_intake.h"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/ros/seconds_between.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const ros::WallDuration kPatience(1.0);  // until the clock is where a transform is
const ros::WallDuration kWarnPeriod(10.0);
// s: so long after time went back transforms of before may come; and so far ahead of the clock are
// those that a simulator sends with its next tick. Chosen.
constexpr double kOnItsWay = 1.0;
constexpr double kAheadOfClock = 0.5;
constexpr double kQuaternionSlack = 1e-2;  // of its square (1): tf2's

// As tf2 takes names: without the slash of earlier versions.
std::string frameOf(const std::string& name) {
  return name.substr(name.rfind('/', 0) == 0 ? 1 : 0);
}

// Why it is no transform, whenever it comes; empty: it is one. The buffer would say some of this,
// of each that comes, in two lines each; infinite numbers it would take.
std::string whyNone(const geometry_msgs::TransformStamped& transform) {
  const std::string child = frameOf(transform.child_frame_id);
  const std::string parent = frameOf(transform.header.frame_id);
  if (child.empty()) return "its child_frame_id is empty";
  if (parent.empty()) return "its frame_id is empty";
  if (child == parent) return "its frame_id is the same";
  const auto& move = transform.transform.translation;
  const auto& turn = transform.transform.rotation;
  const double square = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w;
  if (!std::isfinite(move.x + move.y + move.z + square)) return "numbers in it are not finite";
  return std::abs(square - 1.0) > kQuaternionSlack ? "its quaternion is not of length 1" : "";
}

}  // namespace

TransformIntake::TransformIntake(tf2::BufferCore& buffer, std::function<bool()> time_went_back)
    : buffer_(buffer), time_went_back_(std::move(time_went_back)) {}

void TransformIntake::take(const tf2_msgs::TFMessage& message, Kind kind) {
  if (time_went_back_()) {
    newest_.clear();
    went_back_to_ = ros::Time::now();
  }
  warnOfAhead();
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string why = whyNone(transform);
    if (!why.empty()) {
      refuse(transform, why);
    } else if (kind == Kind::kStatic || hasPlace(transform)) {
      put(transform, kind);
    }
  }
}

std::string TransformIntake::refused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refused_;
}

// One of no frame is only warned of: no good one would ever take that back.
void TransformIntake::refuse(const geometry_msgs::TransformStamped& transform,
                             const std::string& why) {
  const std::string& frame = transform.child_frame_id;
  const std::string line = "the transform of '" + shortText(frame) + "' is left out, as " + why;
  ROS_WARN_STREAM_THROTTLE(10.0, "/tf: " << line);
  if (frame.empty()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  refused_frame_ = frame;
  refused_ = line;
}

// The buffer takes none twice.
void TransformIntake::put(const geometry_msgs::TransformStamped& transform, Kind kind) {
  try {
    buffer_.setTransform(transform, "/tf", kind == Kind::kStatic);
  } catch (const tf2::TransformException& error) {
    ROS_WARN_STREAM_THROTTLE(10.0, "/tf: " << reasonText(error));
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (refused_frame_ == transform.child_frame_id) refused_.clear();
}

// Whether the buffer can take the transform: it is no farther ahead of the clock, or behind the
// newest of its frame, than the buffer is long. Before there is a clock, none.
bool TransformIntake::hasPlace(const geometry_msgs::TransformStamped& transform) {
  const ros::Time now = ros::Time::now(), stamp = transform.header.stamp;
  if (now.isZero()) return false;
  const double most = buffer_.getCacheLength().toSec();
  if (secondsBetween(now, stamp) > most) {
    if (!ahead_) ahead_ = Ahead{transform.child_frame_id, stamp, ros::SteadyTime::now()};
    return false;
  }
  if (isOfBefore(now, stamp)) return false;
  ros::Time& newest = newest_[transform.child_frame_id];
  if (secondsBetween(stamp, newest) > most) return false;
  newest = std::max(newest, stamp);
  return true;
}

// Where time went back just now, what is ahead of it was still on its way. Put in, it would be the
// newest until time has come there.
bool TransformIntake::isOfBefore(const ros::Time& now, const ros::Time& stamp) const {
  return went_back_to_ && secondsBetween(*went_back_to_, now) < kOnItsWay &&
         secondsBetween(now, stamp) > kAheadOfClock;
}

void TransformIntake::warnOfAhead() {
  if (!ahead_) return;
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double ahead = secondsBetween(ros::Time::now(), ahead_->stamp);
  const double most = buffer_.getCacheLength().toSec();
  if (ahead > most && now - ahead_->seen < kPatience) return;
  if (ahead > most && (warned_.isZero() || now - warned_ > kWarnPeriod)) {
    warned_ = now;
    ROS_WARN_STREAM("/tf: the transform of '"
                    << shortText(ahead_->frame) << "' is " << secondsText(ahead)
                    << " s ahead of now and left out; allowed: at most " << numberText(most)
                    << " s, that the buffer holds");
  }
  ahead_.reset();
}

}  // namespace robot_tissue
