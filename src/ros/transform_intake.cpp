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

// Why the buffer takes no such transform, whenever it comes; empty: it does.
std::string whyNone(const geometry_msgs::TransformStamped& transform) {
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
    if (kind == Kind::kMoving && !hasPlace(transform)) continue;
    try {
      put(transform, kind);
    } catch (const tf2::TransformException& error) {
      ROS_WARN_STREAM_THROTTLE(10.0, "/tf: " << onOneLine(error.what()));
    }
  }
}

std::string TransformIntake::refused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refused_;
}

// The buffer says itself, in the log, why it does not take one. It takes none twice, too.
void TransformIntake::put(const geometry_msgs::TransformStamped& transform, Kind kind) {
  buffer_.setTransform(transform, "/tf", kind == Kind::kStatic);
  const std::string& frame = transform.child_frame_id;
  const std::string why = whyNone(transform);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!why.empty()) {
    refused_frame_ = frame;
    refused_ = "the transform of '" + shortText(frame) + "' is left out, as " + why;
  } else if (refused_frame_ == frame) {
    refused_.clear();
  }
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
                    << shortText(ahead_->frame) << "' is " << numberText(ahead)
                    << " s ahead of now and left out; allowed: at most " << numberText(most)
                    << " s, that the buffer holds");
  }
  ahead_.reset();
}

}  // namespace robot_tissue
