// replay: the same bytes on every run and number of threads, and one line for a bag that is wrong.
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <robot_tissue/Surface.h>
#include <robot_tissue/TissueState.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt64.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "replay.h"

namespace robot_tissue {
namespace {

namespace fs = std::filesystem;

const std::string kTissue =
    "tissue:\n"
    "  shape: {type: box, min: [0, 0, 0], max: [0.08, 0.08, 0.04]}\n"
    "  spacing: 0.01\n"
    "  material: {young_modulus: 10000.0}\n"
    "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n";
const std::string kScene =
    kTissue + "tools: [{name: probe, link: tip, shapes: [{type: sphere, radius: 0.01}]}]\n";
const std::string kSceneOfUrdf = kTissue + "tools: [{name: probe, link: tip}]\n";
const std::string kUrdf =
    "<robot name='r'><link name='base'/><link name='tip'><collision><geometry>"
    "<sphere radius='0.01'/></geometry></collision></link><joint name='j' type='fixed'>"
    "<parent link='base'/><child link='tip'/></joint></robot>";
constexpr double kStart = 1000.0;     // s, of the bag
constexpr double kGapFrom = 0.4;      // s after the start: no poses come
constexpr double kGapTo = 2.0;        // s
constexpr double kEnd = 2.4;          // s
constexpr double kPosePeriod = 0.01;  // s
constexpr double kTop = 0.04 + 0.01;  // m, of the block, and the sphere's radius
constexpr double kDeepest = 0.004;    // m

geometry_msgs::TransformStamped tipAt(const ros::Time& stamp, double depth) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = "tissue";
  transform.child_frame_id = "tip";
  transform.transform.translation.x = transform.transform.translation.y = 0.04;
  transform.transform.translation.z = kTop - depth;
  transform.transform.rotation.w = 1.0;
  return transform;
}

class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("replay_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("scene.yaml", kScene);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string bytes(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // The tip goes down and up; between there are no poses for a while.
  void record(const std::string& name, const std::string& topic = "/tf",
              const std::string& description = "") const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    if (!description.empty()) {
      std_msgs::String text;
      text.data = description;
      bag.write("/robot_description", ros::Time(kStart), text);
    }
    for (int i = 0; i * kPosePeriod < kEnd; ++i) {
      const double t = i * kPosePeriod;
      if (t > kGapFrom && t < kGapTo) continue;
      const ros::Time stamp(kStart + t);
      tf2_msgs::TFMessage message;
      message.transforms = {tipAt(stamp, kDeepest * std::sin(M_PI * t / kEnd))};
      bag.write(topic, stamp + ros::Duration(0.002), message);
    }
  }

  // A pose at the start, and one after a gap (s).
  void recordWithGap(const std::string& name, double gap) const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    for (const double t : {0.0, 0.01, gap, gap + 0.01}) {
      tf2_msgs::TFMessage message;
      message.transforms = {tipAt(ros::Time(kStart + t), 0.0)};
      bag.write("/tf", ros::Time(kStart + t), message);
    }
  }

  int run(const std::string& in, const std::string& out, std::vector<std::string> more = {},
          const std::string& scene = "scene.yaml") {
    more.insert(more.begin(), {path(scene), path(in), path(out)});
    std::ostringstream said, complained;
    const int code =
        replay(more, said, complained, [this] { return is_stopped_ || --asks_left_ < 0; });
    said_ = said.str();
    complained_ = complained.str();
    return code;
  }
  void expectRefused(const std::string& in, const std::string& why,
                     const std::vector<std::string>& more = {},
                     const std::string& scene = "scene.yaml") {
    EXPECT_EQ(run(in, "refused.bag", more, scene), 2) << why;
    EXPECT_NE(complained_.find(why), std::string::npos) << complained_;
    EXPECT_EQ(std::count(complained_.begin(), complained_.end(), '\n'), 1) << complained_;
    EXPECT_FALSE(fs::exists(path("refused.bag"))) << why;
    EXPECT_FALSE(fs::exists(path("refused.bag.active"))) << why;
  }

  template <class Message>
  std::vector<Message> read(const std::string& name, const std::string& topic) const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery("/robot_tissue/" + topic));
    std::vector<Message> messages;
    for (const rosbag::MessageInstance& message : view) {
      const auto read = message.instantiate<Message>();
      if (read) messages.push_back(*read);
      if constexpr (!std::is_same_v<Message, std_msgs::UInt64>) {
        EXPECT_EQ(read->header.stamp, message.getTime());
      }
    }
    return messages;
  }

  fs::path folder_;
  std::string said_, complained_;
  bool is_stopped_ = false;
  int asks_left_ = 100000;  // until it is stopped
};

// Each run is a process of its own, as a user's.
TEST_F(Replay, GivesTheSameBytesOnEveryRunAndNumberOfThreads) {
  record("in.bag");
  std::string first;
  for (const std::string threads : {"1", "2", "2"}) {
    const std::string command = std::string(REPLAY_PATH) + " '" + path("scene.yaml") + "' '" +
                                path("in.bag") + "' '" + path("out.bag") +
                                "' --surface --nodes --threads " + threads + " > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    if (first.empty()) first = bytes("out.bag");
    EXPECT_TRUE(bytes("out.bag") == first) << threads << " threads";
  }
  EXPECT_FALSE(read<Surface>("out.bag", "surface").empty());
}

TEST_F(Replay, TellsAnUpdateAPoseWithItsHash) {
  record("in.bag");
  ASSERT_EQ(run("in.bag", "out.bag"), 0) << complained_;
  const auto hashes = read<std_msgs::UInt64>("out.bag", "state_hash");
  const auto wrenches = read<geometry_msgs::WrenchStamped>("out.bag", "probe/measured_cf");
  EXPECT_GT(hashes.size(), 60u);
  ASSERT_EQ(wrenches.size(), hashes.size());
  const auto deepest = std::max_element(
      wrenches.begin(), wrenches.end(),
      [](const auto& one, const auto& other) { return one.wrench.force.z < other.wrench.force.z; });
  EXPECT_GT(deepest->wrench.force.z, 0.05);  // the tissue pushes the sphere up
  EXPECT_LT(wrenches.front().wrench.force.z, 1e-9);
  EXPECT_EQ(wrenches.front().header.frame_id, "tip");
  EXPECT_TRUE(read<Surface>("out.bag", "surface").empty());
}

TEST_F(Replay, TellsThatPosesAreStaleAndGoesOn) {
  record("in.bag");
  ASSERT_EQ(run("in.bag", "out.bag"), 0) << complained_;
  const auto states = read<TissueState>("out.bag", "state");
  const auto is_stale = [](const TissueState& state) { return state.status == "STALE"; };
  const auto stale = std::find_if(states.begin(), states.end(), is_stale);
  ASSERT_NE(stale, states.end());
  EXPECT_NEAR(stale->header.stamp.toSec(), kStart + kGapFrom + 0.5, 0.15);  // ~tf_timeout
  EXPECT_EQ(states.back().status, "OK");
  EXPECT_GT(states.back().header.stamp.toSec(), kStart + kGapTo);
  for (const TissueState& state : states) EXPECT_EQ(state.solve_ms + state.contact_ms, 0.0);
}

TEST_F(Replay, FollowsAtTheRateThatIsAskedFor) {
  record("in.bag");
  ASSERT_EQ(run("in.bag", "all.bag"), 0) << complained_;
  ASSERT_EQ(run("in.bag", "half.bag", {"--rate", "50"}), 0) << complained_;
  const auto all = read<std_msgs::UInt64>("all.bag", "state_hash").size();
  const auto half = read<std_msgs::UInt64>("half.bag", "state_hash").size();
  EXPECT_NEAR(static_cast<double>(half) / static_cast<double>(all), 0.5, 0.1);
}

TEST_F(Replay, TakesTheRobotFromAFileOrTheBag) {
  write("urdf.yaml", kSceneOfUrdf);
  write("robot.urdf", kUrdf);
  record("in.bag");
  record("with_robot.bag", "/tf", kUrdf);
  ASSERT_EQ(run("in.bag", "file.bag", {"--urdf", path("robot.urdf")}, "urdf.yaml"), 0)
      << complained_;
  const std::string of_file = said_;
  ASSERT_EQ(run("with_robot.bag", "bag.bag", {}, "urdf.yaml"), 0) << complained_;
  EXPECT_EQ(said_, of_file);
  expectRefused("in.bag", "has no shapes and there is no URDF", {}, "urdf.yaml");
  expectRefused("in.bag", "nowhere.urdf", {"--urdf", path("nowhere.urdf")}, "urdf.yaml");
}

TEST_F(Replay, RefusesABagThatIsWrong) {
  expectRefused("nowhere.bag", "is no file");
  write("empty.bag", "");
  expectRefused("empty.bag", "empty.bag");
  record("in.bag");
  const std::string whole = bytes("in.bag");
  for (const std::size_t share : {1, 3, 9}) {
    write("cut.bag", whole.substr(0, whole.size() * share / 10));
    expectRefused("cut.bag", "cut.bag");
  }
  record("other.bag", "/elsewhere");
  expectRefused("other.bag", "neither /tf nor /tf_static");
  write("link.yaml", kTissue +
                         "tools: [{name: probe, link: hand, shapes: [{type: sphere, radius: "
                         "0.01}]}]\n");
  expectRefused("in.bag", "no transform from link 'hand'", {}, "link.yaml");
  rosbag::Bag bag(path("text.bag"), rosbag::bagmode::Write);
  bag.write("/tf", ros::Time(kStart), std_msgs::String());
  bag.close();
  expectRefused("text.bag", "std_msgs/String");
}

TEST_F(Replay, RefusesWrongArguments) {
  record("in.bag");
  expectRefused("in.bag", "--rate: must be followed by a value", {"--rate"});
  expectRefused("in.bag", "--urdf: must be followed by a value, not by --surface",
                {"--urdf", "--surface"});
  expectRefused("in.bag", "replay: --rate = fast: must be a number from 0.01 to 10000 in Hz",
                {"--rate", "fast"});
  expectRefused("in.bag", "threads", {"--threads", "0"});
  expectRefused("in.bag", "--speed", {"--speed", "5"});
  expectRefused("in.bag", "more.bag\": must be SCENE.yaml IN.bag OUT.bag only", {"more.bag"});
  EXPECT_EQ(run("in.bag", "nowhere/out.bag"), 2);
  EXPECT_EQ(run("in.bag", "in.bag"), 2);
  EXPECT_NE(complained_.find("is IN.bag itself"), std::string::npos) << complained_;
  EXPECT_EQ(run("in.bag", "whole.bag"), 0);  // the bag is as before
  write("robot.urdf", kUrdf);
  EXPECT_EQ(run("in.bag", "scene.yaml"), 2);
  EXPECT_NE(complained_.find("which is read; allowed: another file"), std::string::npos);
  EXPECT_EQ(bytes("scene.yaml"), kScene);
  EXPECT_EQ(run("in.bag", "robot.urdf", {"--urdf", path("robot.urdf")}), 2);
  EXPECT_EQ(bytes("robot.urdf"), kUrdf);
}

TEST_F(Replay, WritesBesideWhatIsThereInAnotherPlace) {
  record("out.bag.active");
  const std::string recorded = bytes("out.bag.active");
  ASSERT_EQ(run("out.bag.active", "out.bag"), 0) << complained_;
  EXPECT_TRUE(bytes("out.bag.active") == recorded);
  EXPECT_FALSE(read<std_msgs::UInt64>("out.bag", "state_hash").empty());
  is_stopped_ = true;
  EXPECT_EQ(run("out.bag.active", "out.bag"), 2);
  EXPECT_TRUE(bytes("out.bag.active") == recorded);
  EXPECT_FALSE(fs::exists(path("out.bag.active2")));
}

// Farther ahead than a signed 32-bit number of seconds.
TEST_F(Replay, LeavesATransformOfTheEndOfTimeOut) {
  record("in.bag");
  ASSERT_EQ(run("in.bag", "plain.bag"), 0) << complained_;
  const std::string without = said_;
  rosbag::Bag bag(path("in.bag"), rosbag::bagmode::Append);
  tf2_msgs::TFMessage message;
  message.transforms = {tipAt(ros::TIME_MAX, 0.0)};
  bag.write("/tf", ros::Time(kStart + kGapFrom), message);
  bag.close();
  ASSERT_EQ(run("in.bag", "out.bag"), 0) << complained_;
  EXPECT_EQ(said_, without);
}

// As of a recording that began before the simulated clock: the time between is longer than any
// ros::Duration, and nothing happens in it.
TEST_F(Replay, LeapsOverALongGap) {
  for (const double gap : {3600.0, 4.2e9 - kStart}) {
    recordWithGap("gap.bag", gap);
    ASSERT_EQ(run("gap.bag", "out.bag"), 0) << complained_;
    const auto states = read<TissueState>("out.bag", "state");
    EXPECT_LT(states.size(), 1000u);
    EXPECT_EQ(states.back().status, "OK");
    EXPECT_GT(states.back().header.stamp.toSec(), kStart + gap);
  }
}

TEST_F(Replay, IsStoppedInAGap) {
  recordWithGap("gap.bag", 300.0);
  asks_left_ = 1000;
  EXPECT_EQ(run("gap.bag", "out.bag"), 2);
  EXPECT_NE(complained_.find("stopped by a signal"), std::string::npos) << complained_;
}

// Files of more than some blocks of 512 bytes are refused as on a full disk.
TEST_F(Replay, LeavesNothingOnAFullDisk) {
  record("in.bag");
  for (const int blocks : {1, 8, 40}) {
    const std::string command = "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; exec '" +
                                std::string(REPLAY_PATH) + "' '" + path("scene.yaml") + "' '" +
                                path("in.bag") + "' '" + path("out.bag") +
                                "' --surface --nodes > /dev/null 2> /dev/null";
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2) << status << ", " << blocks;
    EXPECT_FALSE(fs::exists(path("out.bag")));
    EXPECT_FALSE(fs::exists(path("out.bag.active")));
  }
}

TEST_F(Replay, LeavesWhatIsThereWhenItIsStopped) {
  record("in.bag");
  write("out.bag", "of before");
  is_stopped_ = true;
  EXPECT_EQ(run("in.bag", "out.bag"), 2);
  EXPECT_EQ(bytes("out.bag"), "of before");
  EXPECT_FALSE(fs::exists(path("out.bag.active")));
}

}  // namespace
}  // namespace robot_tissue
