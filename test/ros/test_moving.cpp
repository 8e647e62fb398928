// The node with a tissue that moves in time.
#include "node_fixture.h"
#include "robot_tissue/ros/tissue_clock.h"

namespace robot_tissue {
namespace {

class MovingTissue : public NodeTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/reset", ros::Duration(kDeadline)));
    depth_ = -0.05;  // m: away from the tissue
  }
};

TEST(TissueClock, GoesOnByTheStampsAndStandsStillInASilence) {
  TissueClock clock(0.005, 0.1);
  const ros::Time start(1000.0);
  const auto at = [&](double seconds) { return start + ros::Duration(seconds); };
  EXPECT_EQ(clock.advance(at(0.0), true), 0.0);
  EXPECT_NEAR(clock.advance(at(0.02), true), 0.02, 1e-9);
  EXPECT_NEAR(clock.advance(at(0.32), true), 0.12, 1e-9);
  EXPECT_NEAR(clock.leftOut(), 0.2, 1e-9);
  EXPECT_NEAR(clock.advance(at(10.0), false), 0.14, 1e-9);  // at rest: a usual gap
  EXPECT_EQ(clock.leftOut(), 0.0);
  EXPECT_NEAR(clock.advance(at(5.0), true), 0.14, 1e-9);  // time jumped back
  EXPECT_NEAR(clock.advance(at(5.01), true), 0.15, 1e-9);
}

TEST_F(MovingTissue, RestsBesideAToolThatIsAway) {
  ASSERT_TRUE(waitFor([this] { return state_ && state_->status == "OK" && wrench_; }));
  ASSERT_TRUE(reset());
  EXPECT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
  EXPECT_EQ(wrench_->wrench.force.z, 0.0);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_moving");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
