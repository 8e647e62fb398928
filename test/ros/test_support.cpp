// Tissue that lies on a table by its weight alone, and a grasper too weak to lift it.
#include "forceps_fixture.h"

namespace robot_tissue::test_support {
namespace {

constexpr double kWeight = 2000.0 * 9.81 * 0.04 * 0.02 * 0.02;  // N
constexpr double kMostForce = 0.25;  // N: what the grasper holds, less than that
constexpr double kSpacing = 0.005;   // m
constexpr double kMiddle = 0.01;     // of the block, along y and z (m)
constexpr double kOpen = 0.03;       // m between the jaws
constexpr double kClosed = 0.0199;   // m: each is 0.05 mm in the block

class Support : public Forceps {
 protected:
  Support() : Forceps(kMiddle, kMiddle, 0.05, kOpen) {}

  void SetUp() override {
    Forceps::SetUp();
    said_.clear();
  }

  // The table bears what the jaws do not.
  void expectBorne() const {
    const double borne = state_->force_of_supports.z + state_->force_of_tools.z;
    EXPECT_NEAR(borne, kWeight, 0.02 * kWeight);
    EXPECT_NEAR(state_->weight.z, -kWeight, 1e-6);
    EXPECT_LT(state_->unbalanced_force, 0.02 * kWeight);
  }
};

TEST_F(Support, TissueRestsOnItsTable) {
  ASSERT_TRUE(waitFor([this] { return state_->force_of_supports.z > 0.5 * kWeight; }));
  EXPECT_EQ(state_->status, "OK") << state_->message;
  EXPECT_NEAR(state_->force_of_supports.z, kWeight, 0.02 * kWeight);
  EXPECT_EQ(state_->force_of_tools.z, 0.0);
  expectBorne();
  EXPECT_LT(state_->volume_ratio, 1.0);  // under its own weight
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["surface"].points.empty(); }));
  double lowest = kTop;
  for (const auto& point : markers_["surface"].points) lowest = std::min(lowest, point.z);
  EXPECT_NEAR(lowest, 0.0, 0.05 * kSpacing);
}

TEST_F(Support, GrasperTooWeakToLiftItIsTornOff) {
  moveTo(0.0, kOpen);
  moveTo(0.0, kClosed);
  ASSERT_TRUE(waitFor([this] { return !state_->grasping.empty(); })) << state_->message;
  double height = 0.0;
  for (; said_.count("TORN_OFF") == 0 && height < 0.01; height += 0.00025) {
    EXPECT_LT(state_->force_of_tools.z, kMostForce);
    expectBorne();
    moveTo(height, kClosed);
  }
  ASSERT_EQ(said_.count("TORN_OFF"), 1U) << "lifted by " << height;
  EXPECT_NE(said_["TORN_OFF"].find("max_force"), std::string::npos) << said_["TORN_OFF"];
  EXPECT_TRUE(waitFor([this] { return state_->grasping.empty(); }));
  moveTo(height, kOpen);
  EXPECT_NEAR(state_->force_of_supports.z, kWeight, 0.02 * kWeight);
  EXPECT_EQ(wrench_->wrench.force.z, 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_support
