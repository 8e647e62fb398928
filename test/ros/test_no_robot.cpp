// A tool whose shapes are the scene's own needs a transform, and no robot.
#include "node_fixture.h"

namespace robot_tissue::test_no_robot {
namespace {

class NoRobot : public NodeTest {};

TEST_F(NoRobot, ShapesOfTheSceneAreEnough) {
  ASSERT_TRUE(waitFor([this] { return state_ && state_->status == "OK"; }))
      << (state_ ? state_->message : "");
  EXPECT_LT(press(0.004).wrench.force.z, -0.1);
  EXPECT_EQ(said_.count("NO_ROBOT"), 0U);
}

}  // namespace
}  // namespace robot_tissue::test_no_robot
