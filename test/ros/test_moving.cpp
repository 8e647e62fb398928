// The node with a tissue that moves in time.
#include "node_fixture.h"
#include "robot_tissue/ros/tissue_clock.h"

namespace robot_tissue::test_moving {
namespace {

const ros::WallDuration kSilence(0.3);

class MovingTissue : public NodeTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/reset", ros::Duration(kDeadline)));
    depth_ = -0.05;  // m: away from the tissue
  }

  // What the probe is pressed with (N). Tissue that it hits leaps off it, and comes back.
  double forceAtRest() {
    double force = 0.0;
    for (int look = 0; look < 20 && force == 0.0; ++look) {
      force = std::abs(follow().wrench.force.z);
    }
    return force;
  }
};

TEST(TissueClock, GoesOnByTheStampsAndStandsStillInASilence) {
  TissueClock clock(0.005, 0.1);
  const ros::Time start(1000.0);
  const auto at = [&](double seconds) { return start + ros::Duration(seconds); };
  const auto advance = [&](double seconds, bool moves) {
    return clock.advance(at(seconds), moves, clock.now());
  };
  EXPECT_EQ(advance(0.0, true), 0.0);
  EXPECT_NEAR(advance(0.02, true), 0.02, 1e-9);
  EXPECT_NEAR(advance(0.32, true), 0.12, 1e-9);
  EXPECT_NEAR(clock.leftOut(), 0.2, 1e-9);
  EXPECT_NEAR(advance(10.0, false), 0.14, 1e-9);  // at rest: a usual gap
  EXPECT_EQ(clock.leftOut(), 0.0);
  EXPECT_NEAR(advance(5.0, true), 0.14, 1e-9);  // time jumped back
  EXPECT_NEAR(advance(5.01, true), 0.15, 1e-9);
}

TEST(TissueClock, WaitsForATissueThatIsBehind) {
  TissueClock clock(0.005, 0.1);
  const ros::Time start(1000.0);
  for (int pose = 0; pose < 100; ++pose) {
    const double now = clock.advance(start + ros::Duration(0.01 * pose), true, 0.0);
    EXPECT_LE(now, 0.1 + 1e-9);
  }
  EXPECT_NEAR(clock.now(), 0.1, 1e-9);
  EXPECT_NEAR(clock.leftOut(), 0.01, 1e-6);
  EXPECT_NEAR(clock.advance(start + ros::Duration(1.0), true, 0.1), 0.11, 1e-6);
}

TEST_F(MovingTissue, RestsBesideAToolThatIsAway) {
  ASSERT_TRUE(waitFor([this] { return state_ && state_->status == "OK" && wrench_; }));
  ASSERT_TRUE(reset());
  EXPECT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
  EXPECT_EQ(wrench_->wrench.force.z, 0.0);
}

// A robot that presses, falls silent, goes on and lets go. Poses come when they come.
TEST_F(MovingTissue, IsPressedThroughASilenceAndLetGo) {
  ASSERT_TRUE(waitFor([this] { return state_ && state_->status == "OK" && wrench_; }));
  depth_ = 0.004;
  const double pressed = forceAtRest();
  EXPECT_GT(pressed, 0.4);
  publishes_transform_ = false;
  const ros::WallTime silent = ros::WallTime::now();
  waitFor([&] { return ros::WallTime::now() - silent > kSilence; });
  publishes_transform_ = true;
  EXPECT_NEAR(forceAtRest(), pressed, 0.02 * pressed);
  // A vertex beneath the probe is as deep as it, or deeper in a ring of triangles that bear it.
  EXPECT_TRUE(waitForMarkers([this] { return std::abs(kTop - lowestOfTop() - 0.004) < 0.0015; }));
  EXPECT_EQ(press(-0.05).wrench.force.z, 0.0);
  EXPECT_TRUE(waitForMarkers([this] { return std::abs(lowestOfTop() - kTop) < 1e-5; }));
}

}  // namespace
}  // namespace robot_tissue::test_moving
