// A grasper whose jaws are links of the robot, and supports.
#include <cmath>

#include "forceps_fixture.h"

namespace robot_tissue::test_gripper {
namespace {

constexpr double kWallTop = 0.03;  // m
constexpr double kMiddle = 0.005;  // of the wall along y (m)
constexpr double kOpen = 0.018;    // m between the jaws
constexpr double kClosed = 0.009;  // m: each jaw is 0.5 mm in the wall

class Gripper : public Forceps {
 protected:
  Gripper() : Forceps(kMiddle, kWallTop, 0.02, kOpen) {}

  bool holds() {
    return waitFor([this] { return state_->grasping == std::vector<std::string>{"forceps"}; });
  }
  bool says(const std::string& words) const {
    return state_->message.find(words) != std::string::npos;
  }
};

TEST_F(Gripper, HoldsWhatIsBetweenItsJawsUntilTheyOpen) {
  moveTo(0.0, kOpen);
  moveTo(0.0, kClosed);
  ASSERT_TRUE(holds()) << state_->message;
  const double pull = moveTo(0.002, kClosed).z;  // the wall pulls it down
  EXPECT_LT(pull, -0.1);
  EXPECT_GT(pull, -3.0);  // E A d / h beneath the jaws is 0.2 N
  EXPECT_EQ(wrench_->header.frame_id, "left_jaw");
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["loading_patches"].points.empty(); }));
  EXPECT_TRUE(waitForMarkers([this] { return markers_["contact_normals"].points.size() == 2; }));
  ASSERT_TRUE(waitForContacts());
  const auto& normal = contacts_->contacts.front().normal;  // of the left jaw
  EXPECT_NEAR(std::hypot(normal.x, normal.y, normal.z), 1.0, 1e-9);
  EXPECT_GT(normal.y, 0.8);
  moveTo(0.002, kOpen);
  EXPECT_TRUE(waitFor([this] { return state_->grasping.empty(); }));
  EXPECT_EQ(wrench_->wrench.force.z, 0.0);
}

TEST_F(Gripper, GraspsAndReleasesByService) {
  const auto nothing = ask("grasp", "forceps");
  EXPECT_FALSE(nothing.success);
  EXPECT_NE(nothing.message.find("'forceps'"), std::string::npos) << nothing.message;
  EXPECT_NE(nothing.message.find("no tissue is between its jaws"), std::string::npos)
      << nothing.message;
  moveTo(0.0, kOpen);
  EXPECT_EQ(state_->message, "") << "its jaws are open, as they may be";
  moveTo(0.0, 0.0098);  // farther than close_gap
  EXPECT_TRUE(state_->grasping.empty());
  EXPECT_TRUE(waitFor([this] { return says("not closer than grasp.close_gap"); }));
  EXPECT_EQ(state_->status, "OK");
  const auto grasped = ask("grasp", "forceps");
  ASSERT_TRUE(grasped.success) << grasped.message;
  ASSERT_TRUE(holds());
  const double pull = moveTo(0.002, 0.0098).z;
  EXPECT_LT(pull, -0.1);
  EXPECT_GT(pull, -3.0);
  const auto released = ask("release", "forceps");
  ASSERT_TRUE(released.success) << released.message;
  EXPECT_TRUE(waitFor([this] { return state_->grasping.empty(); }));
  EXPECT_FALSE(ask("release", "forceps").success);
}

TEST_F(Gripper, GraspsAndReleasesWithoutAPoseToo) {
  moveTo(0.0, kOpen);
  moveTo(0.0, 0.0098);  // farther than close_gap
  publishes_transform_ = false;
  ASSERT_TRUE(waitFor([this] { return state_->status == "STALE"; }));
  const auto grasped = ask("grasp", "forceps");
  ASSERT_TRUE(grasped.success) << grasped.message;
  EXPECT_NE(grasped.message.rfind("0 nodes", 0), 0u) << grasped.message;
  ASSERT_TRUE(holds());
  const auto released = ask("release", "forceps");
  EXPECT_TRUE(released.success) << released.message;
  EXPECT_TRUE(waitFor([this] { return state_->grasping.empty(); }));
  EXPECT_FALSE(ask("release", "forceps").success);
  publishes_transform_ = true;
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
}

TEST_F(Gripper, JawsInEachOtherAreReported) {
  moveTo(0.05, -0.001);
  EXPECT_TRUE(waitFor([this] { return state_->message.find("forceps") != std::string::npos; }));
  EXPECT_EQ(state_->status, "OK");
  const auto is_diagnosed = [this] {
    const auto& tools = diagnostics_["tissue: tools"];
    return tools.message.find("the jaws of 'forceps'") != std::string::npos &&
           tools.level == diagnostic_msgs::DiagnosticStatus::WARN;
  };
  EXPECT_TRUE(waitFor(is_diagnosed));
  moveTo(0.05, kOpen);
  EXPECT_TRUE(waitFor([this] { return state_->message.empty(); }));
  EXPECT_TRUE(waitFor([this] { return diagnostics_["tissue: tools"].message == "followed"; }));
}

TEST_F(Gripper, JawThatVanishesIsNamed) {
  moveTo(0.0, kOpen);
  publishes_transform_ = false;
  const auto left_only = [this] {
    auto some = transforms();
    some.pop_back();
    broadcaster_.sendTransform(some);
    return state_->status == "STALE";
  };
  ASSERT_TRUE(waitFor(left_only));
  EXPECT_NE(state_->message.find("'right_jaw'"), std::string::npos) << state_->message;
  publishes_transform_ = true;
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
}

TEST_F(Gripper, SupportsAreShown) {
  ASSERT_TRUE(waitForMarkers([this] { return markers_.count("supports1") > 0; }));
  const auto& table = markers_["supports"];
  EXPECT_EQ(table.type, visualization_msgs::Marker::CUBE);
  EXPECT_NEAR(table.pose.position.x, 0.02, 1e-12);  // under the middle of the wall
  EXPECT_NEAR(table.pose.position.z + 0.5 * table.scale.z, 0.0, 1e-12);
  EXPECT_GT(table.scale.x, 0.04);
  const auto& shelf = markers_["supports1"];
  EXPECT_NEAR(shelf.pose.position.x, 0.11, 1e-12);
  EXPECT_NEAR(shelf.scale.y, 0.1, 1e-12);
}

}  // namespace
}  // namespace robot_tissue::test_gripper
