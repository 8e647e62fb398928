// A tool that races in and out of the tissue, faster than the node can follow: what is told of a
// pose is of that pose.
#include <set>

#include "node_fixture.h"

namespace robot_tissue::test_stamps {
namespace {

constexpr double kClear = 0.01, kDeep = 0.006;  // of the probe's lowest point above, beneath (m)
constexpr double kFlat = 0.003;  // of the probe's lowest point: so high its side may touch (m)

class Stamps : public NodeTest {
 protected:
  Stamps() {
    subscribers_.push_back(node_.subscribe<geometry_msgs::WrenchStamped>(
        "/tissue/probe/measured_cf", 5000,
        [this](const geometry_msgs::WrenchStampedConstPtr& wrench) {
          const auto& force = wrench->wrench.force;
          isTold(wrench->header.stamp, std::hypot(force.x, force.y, force.z), wrenches_);
          solved_.insert(wrench->header.stamp);
        }));
    subscribers_.push_back(node_.subscribe<geometry_msgs::WrenchStamped>(
        "/tissue/probe/predicted_cf", 5000,
        [this](const geometry_msgs::WrenchStampedConstPtr& wrench) {
          const auto& force = wrench->wrench.force;
          const ros::Time stamp = wrench->header.stamp;
          isTold(stamp, std::hypot(force.x, force.y, force.z), predictions_);
          const ros::Time before = predicted_.empty() ? ros::Time() : *predicted_.rbegin();
          EXPECT_GE(stamp, before) << "went back";
          const bool is_deep = depths_[stamp] == kDeep;
          EXPECT_LT(force.z, is_deep ? -0.1 : 1e-6) << "N, " << depths_[stamp] << " m deep";
          predicted_.insert(stamp);
        }));
    subscribers_.push_back(node_.subscribe<ContactArray>(
        "/tissue/contacts", 5000, [this](const ContactArrayConstPtr& array) {
          double force = 0.0;
          for (const TissueContact& contact : array->contacts) force += std::abs(contact.force.z);
          isTold(array->header.stamp, force, arrays_);
        }));
    subscribers_.push_back(node_.subscribe<visualization_msgs::MarkerArray>(
        "/tissue/markers", 5000, [this](const visualization_msgs::MarkerArrayConstPtr& array) {
          for (const auto& marker : array->markers) {
            if (marker.ns != "force_labels" || marker.text.empty()) continue;
            isTold(marker.header.stamp,
                   std::stod(marker.text.substr(marker.text.find_first_not_of('('))), labels_);
          }
        }));
    publishes_transform_ = false;
  }

  void isTold(const ros::Time& stamp, double force, int& count) {
    ++count;
    last_told_ = std::max(last_told_, stamp);
    const auto pose = depths_.find(stamp);
    ASSERT_NE(pose, depths_.end()) << "of no pose that was sent";
    if (pose->second < -kFlat) {
      EXPECT_LT(force, 1e-6) << "N, " << -pose->second << " m above the tissue";
    }
  }

  // One pose, all of one stamp.
  void send() {
    auto all = transforms();
    for (auto& transform : all) transform.header.stamp = all.front().header.stamp;
    depths_[all.front().header.stamp] = depth_;
    broadcaster_.sendTransform(all);
  }

  bool sendUntil(const std::function<bool()>& condition) {
    return waitFor([&] {
      send();
      return condition();
    });
  }

  bool arrives(double depth) {
    depth_ = depth;
    const ros::Time moved = ros::Time::now();
    return sendUntil([&] { return wrench_ && wrench_->header.stamp > moved; });
  }

  // The node says that it is behind.
  bool falls_behind(double depth) {
    depth_ = depth;
    said_.clear();
    return sendUntil([this] { return said_.count("TOO_FAST") + said_.count("LATE") > 0; });
  }

  std::map<ros::Time, double> depths_;  // of the probe (m), by stamps of the poses sent
  ros::Time last_told_;
  std::set<ros::Time> solved_, predicted_;  // stamps
  int wrenches_ = 0, predictions_ = 0, arrays_ = 0, labels_ = 0;
};

TEST_F(Stamps, AreOfThePosesThatTheTissueReached) {
  ASSERT_TRUE(arrives(-kClear));
  for (int time = 0; time < 5; ++time) {
    const ros::Time reached = last_told_;
    ASSERT_TRUE(falls_behind(kDeep));
    ASSERT_TRUE(falls_behind(-kClear));
    EXPECT_GE(last_told_, reached);
  }
  ASSERT_TRUE(arrives(kDeep));
  ASSERT_TRUE(sendUntil([this] { return state_->status == "OK"; }));
  EXPECT_LT(wrench_->wrench.force.z, -0.1);
  EXPECT_TRUE(sendUntil([this] { return arrays_ > 0 && labels_ > 0; }));
  ASSERT_TRUE(falls_behind(-kClear));
  ASSERT_TRUE(arrives(-kClear));
  EXPECT_EQ(wrench_->wrench.force.z, 0.0);
  ASSERT_TRUE(sendUntil([this] { return last_told_ <= *solved_.rbegin(); }));
  for (const ros::Time& stamp : predicted_) {
    const auto later = solved_.upper_bound(stamp);
    ASSERT_NE(later, solved_.begin());
    EXPECT_LT((stamp - *std::prev(later)).toSec(), 0.25) << "s after the last pose solved for";
  }
  EXPECT_GT(wrenches_, 2);
  EXPECT_GT(predictions_, 2);
}

}  // namespace
}  // namespace robot_tissue::test_stamps
