// A node in simulated time, with this test as its clock: time that is not there yet, goes on slowly
// told poses, and goes back as where a bag plays again.
#include <rosgraph_msgs/Clock.h>
#include <rosgraph_msgs/Log.h>

#include <algorithm>
#include <limits>

#include "node_fixture.h"

namespace robot_tissue::test_sim_time {
namespace {

constexpr int kNoPose = std::numeric_limits<int>::max();
constexpr int kLooksAPose = 30;  // of waitFor

class SimTime : public NodeTest {
 protected:
  SimTime() : clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 100)) {
    publishes_transform_ = false;
    subscribers_.push_back(node_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& line) {
          if (line->name == "/tissue" && line->level >= rosgraph_msgs::Log::WARN) {
            warnings_.push_back(line->msg);
          }
        }));
    subscribers_.push_back(node_.subscribe<TissueState>(
        "/tissue/state", 1000,
        [this](const TissueStateConstPtr& state) { stamps_.push_back(state->header.stamp); }));
  }

  // The clock goes on by a step, with a pose of its time in every so many of them.
  void tick(int steps_a_pose = 1) {
    now_ += step_;
    rosgraph_msgs::Clock message;
    message.clock = now_;
    clock_.publish(message);
    if (++steps_ % steps_a_pose == 0) sendPose(now_);
  }

  void sendPose(const ros::Time& stamp) {
    auto all = transforms();
    for (auto& transform : all) transform.header.stamp = stamp;
    broadcaster_.sendTransform(all);
  }

  bool tickUntil(const std::function<bool()>& condition, int steps_a_pose = 1) {
    return waitFor([&] {
      tick(steps_a_pose);
      return condition();
    });
  }

  bool warnsOf(const std::string& text) const {
    return std::any_of(warnings_.begin(), warnings_.end(), [&](const std::string& warning) {
      return warning.find(text) != std::string::npos;
    });
  }

  std::vector<geometry_msgs::TransformStamped> transforms() const override {
    auto all = NodeTest::transforms();
    all.back().transform.translation.x += 0.4 * aside_;
    all.back().transform.translation.y += 0.6 * aside_;
    return all;
  }

  // From this time on, until the node is at work.
  void playFrom(double seconds, double depth) {
    now_ = ros::Time(seconds);
    depth_ = depth;
    const auto is_there = [&] {
      return state_ && state_->status == "OK" && wrench_ && wrench_->header.stamp >= played_from_ &&
             wrench_->header.stamp <= now_;
    };
    played_from_ = now_;
    wrench_.reset();
    ASSERT_TRUE(tickUntil(is_there));
  }

  // What was sent so far has been worked off: the last pose, as its wrench came (one that the node
  // left out for its rate is followed by another); then, asked twice, no state came in between.
  void drain() {
    int looks = 0;
    ASSERT_TRUE(waitFor([&] {
      const bool is_there = wrench_->header.stamp == now_;
      if (!is_there && ++looks % kLooksAPose == 0) tick();
      return is_there;
    }));
    ASSERT_TRUE(waitFor([this] {
      stamps_.clear();
      ask("release", "nothing");
      ros::spinOnce();
      return stamps_.empty();
    }));
  }

  ros::Publisher clock_;
  ros::Time now_, played_from_;
  ros::Duration step_{0.02};  // of the clock
  int steps_ = 0;
  double aside_ = 0.0;  // m: of the probe, off the node under it
  std::vector<std::string> warnings_;
  std::vector<ros::Time> stamps_;  // of states
};

// The first one: there is no time yet.
TEST_F(SimTime, WithoutAClockIsWarnedAboutAndWaitedFor) {
  ASSERT_TRUE(waitFor([this] { return warnsOf("/clock"); }));
  playFrom(100.0, -0.01);
  EXPECT_FALSE(warnsOf("no transform"));
  ASSERT_TRUE(tickUntil([this] { return diagnostics_.count("tissue: update rate") > 0; }));
}

TEST_F(SimTime, PosesAtAnyRateKeepUp) {
  playFrom(200.0, -0.01);
  for (const double rate_hz : {10.0, 30.0, 50.0, 200.0}) {
    step_ = ros::Duration(1.0 / rate_hz);
    for (int period = 0; period < 2; ++period) {
      diagnostics_.clear();
      ASSERT_TRUE(tickUntil([this] { return diagnostics_.count("tissue: update rate") > 0; }));
    }
    for (const auto& [name, status] : diagnostics_) {
      EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::OK)
          << rate_hz << " Hz: " << name << ": " << status.message;
    }
    EXPECT_EQ(diagnostics_["tissue: update rate"].message, "keeps up");
  }
}

TEST_F(SimTime, ABagThatPlaysAgainWarnsOnceAtMost) {
  playFrom(300.0, 0.004);
  warnings_.clear();
  for (int loop = 0; loop < 3; ++loop) {
    ASSERT_TRUE(tickUntil([this] { return state_->force_of_tools.z < -0.05; }));
    drain();
    now_ = ros::Time(240.0);  // as the bag begins, its clock before its first pose
    ASSERT_TRUE(tickUntil(
        [this] { return state_->status == "NO_TRANSFORM" && state_->header.stamp <= now_; },
        kNoPose))
        << "loop " << loop << ": " << state_->status << " at " << state_->header.stamp << ", "
        << state_->message << "; now " << now_;
    playFrom(250.0, -0.03);
    for (const ros::Time& stamp : stamps_) EXPECT_LT(stamp.toSec(), 290.0) << "of before";
    EXPECT_EQ(wrench_->wrench.force.z, 0.0);
    depth_ = 0.004;
    now_ = ros::Time(300.0);
    ASSERT_TRUE(tickUntil([this] { return wrench_->header.stamp.toSec() > 300.0; }));
  }
  const auto tells_of_time = [](const std::string& warning) {
    return warning.find("time went back") != std::string::npos;
  };
  EXPECT_LE(std::count_if(warnings_.begin(), warnings_.end(), tells_of_time), 1);
  for (const char* text :
       {"no transform", "NO_TRANSFORM", "jumped", "appeared", "ahead of now", "future"}) {
    EXPECT_FALSE(warnsOf(text)) << text;
  }
}

// The same poses one by one, at the wall's speed and at five times that: which are followed hangs
// on the machine, but not what is told of one. Right over a node all touches around it come and go
// at once, and when they do hangs on the way there.
TEST_F(SimTime, ABagTellsTheSameOfAPoseAtAnySpeed) {
  constexpr int kPoses = 100;
  aside_ = 0.005;
  std::map<int, double> slowly;  // by the number of its pose: force along z (N)
  double greatest = 0.0, start = 500.0;
  for (const double speed : {0.0, 1.0, 5.0}) {
    std::map<int, double> forces;
    playFrom(start, -0.01);
    const ros::Time begin = now_;
    const ros::Subscriber listener = node_.subscribe<geometry_msgs::WrenchStamped>(
        "/tissue/probe/measured_cf", 1000, [&](const geometry_msgs::WrenchStampedConstPtr& wrench) {
          const double steps = (wrench->header.stamp - begin).toSec() / step_.toSec();
          if (steps < 0.5) return;  // of before
          EXPECT_NEAR(steps, std::round(steps), 1e-3);
          forces[static_cast<int>(std::round(steps))] = wrench->wrench.force.z;
        });
    ASSERT_TRUE(waitFor([&] { return listener.getNumPublishers() > 0; }));
    ros::WallRate beat(std::max(speed, 1.0) / step_.toSec());
    for (int pose = 1; pose <= kPoses; ++pose) {
      depth_ = 0.004 * std::sin(M_PI * pose / kPoses);
      tick();
      ros::spinOnce();
      if (speed > 0.0) beat.sleep();
      int looks = 0;  // one that the node leaves out for its rate does not come
      if (speed == 0.0) waitFor([&] { return forces.count(pose) > 0 || ++looks > kLooksAPose; });
    }
    drain();
    start += 100.0;
    if (speed == 0.0) slowly = forces;
    for (const auto& [pose, force] : forces) greatest = std::max(greatest, std::abs(force));
    EXPECT_GT(forces.size(), 1U) << "at speed " << speed;
    for (const auto& [pose, force] : forces) {
      const auto known = slowly.find(pose);
      if (known == slowly.end()) continue;
      EXPECT_NEAR(force, known->second, 0.05 * greatest) << "pose " << pose << ", speed " << speed;
    }
  }
  EXPECT_GT(greatest, 0.1);
  EXPECT_GT(slowly.size(), 0.9 * kPoses);
}

TEST_F(SimTime, TransformsFromTheFutureBlindNobody) {
  playFrom(400.0, -0.01);
  sendPose(ros::TIME_MAX);
  sendPose(now_ + ros::Duration(3600.0));
  ASSERT_TRUE(tickUntil([this] { return warnsOf(" s ahead of now"); }));
  depth_ = 0.004;
  EXPECT_TRUE(
      tickUntil([this] { return state_->status == "OK" && wrench_->wrench.force.z < -0.1; }));
  EXPECT_LT(wrench_->header.stamp, now_ + ros::Duration(1.0));
}

// Farther than any ros::Duration tells, as where a simulated clock that began at zero is set to the
// wall's, and back again.
TEST_F(SimTime, AClockThatLeapsFarIsFollowed) {
  for (const double start : {1000.0, 4.2e9, 2000.0}) {
    playFrom(start, 0.004);
    EXPECT_TRUE(tickUntil([this] { return state_->header.stamp >= played_from_; })) << start;
  }
}

}  // namespace
}  // namespace robot_tissue::test_sim_time
