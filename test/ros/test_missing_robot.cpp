// A node that is started before its robot: it says what it waits for, and goes on when it is there.
#include "node_fixture.h"

namespace robot_tissue::test_missing_robot {
namespace {

class MissingRobot : public NodeTest {};

TEST_F(MissingRobot, DescriptionThenFrameAreReportedAndWaitedFor) {
  publishes_transform_ = false;
  ASSERT_TRUE(waitFor([this] { return state_ && state_->status == "NO_ROBOT"; }));
  EXPECT_NE(state_->message.find("robot_description"), std::string::npos);
  EXPECT_TRUE(waitFor([this] {
    return diagnostics_.count("tissue: transforms") > 0 &&
           diagnostics_["tissue: transforms"].level == diagnostic_msgs::DiagnosticStatus::ERROR;
  }));
  EXPECT_EQ(diagnostics_["tissue: tools"].message, "not followed: no good pose");
  EXPECT_TRUE(waitFor([this] { return markers_.count("surface") > 0; })) << "tissue is not shown";

  std::string urdf;
  ASSERT_TRUE(node_.getParam("late_description", urdf));
  node_.setParam("/robot_description", urdf);
  ASSERT_TRUE(waitFor([this] { return state_->status == "NO_TRANSFORM"; }));
  EXPECT_NE(state_->message.find("tissue"), std::string::npos);
  EXPECT_EQ(state_->message.find('\n'), std::string::npos);

  publishes_transform_ = true;
  ASSERT_TRUE(waitFor([this] { return state_->status == "OK"; }));
  const auto wrench = press(0.004);
  EXPECT_LT(wrench.wrench.force.z, -0.1);
}

}  // namespace
}  // namespace robot_tissue::test_missing_robot
