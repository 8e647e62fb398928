// A node with a grasper of two jaws, links of the robot that close along y.
#pragma once

#include "node_fixture.h"

namespace robot_tissue {

class Forceps : public NodeTest {
 protected:
  // The jaws meet at `middle` along y, heights count from `base` along z; where they start (m).
  Forceps(double middle, double base, double height, double gap)
      : NodeTest("forceps"), middle_(middle), base_(base), height_(height), gap_(gap) {}

  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/reset", ros::Duration(kDeadline)));
    follow();
    ASSERT_TRUE(reset());
    follow();
    ASSERT_TRUE(waitFor([this] { return state_ && state_->grasping.empty(); }));
  }

  std::vector<geometry_msgs::TransformStamped> transforms() const override {
    constexpr double kJawHalf = 0.002;  // half a jaw's thickness (m)
    const double aside = 0.5 * gap_ + kJawHalf;
    return {transform("tissue", 1.0, 0.0, 0.0),
            transform("left_jaw", 1.02, middle_ - aside, base_ + height_),
            transform("right_jaw", 1.02, middle_ + aside, base_ + height_)};
  }

  // Force on the grasper (N) there.
  geometry_msgs::Vector3 moveTo(double height, double gap) {
    height_ = height;
    gap_ = gap;
    return follow().wrench.force;
  }

 private:
  double middle_, base_;
  double height_;  // of the jaws' middle (m)
  double gap_;     // between the jaws (m)
};

}  // namespace robot_tissue
