// How far the points of a link go where it turns about an axis that is not at its origin.
#include <gtest/gtest.h>

#include <random>

#include "pipeline_fixtures.h"
#include "robot_tissue/pipeline/between.h"
#include "robot_tissue/pipeline/still_pose.h"

namespace robot_tissue::test_way_lengths {
namespace {

constexpr double kShaft = 0.4;  // from the link's origin to the middle of its ball (m)

// A ball at the end of an instrument whose frame is far from it, above the block.
ToolGeometry instrument() { return probe("instrument", Vec3(0.0, 0.0, -kShaft)); }

// The ball pressed in by 2 mm, with the instrument turned.
RobotPose turnedBy(const Eigen::AngleAxisd& turn) {
  RobotPose pose = pressed(0.002);
  Pose& link = pose.links.front();
  link.linear() = turn.toRotationMatrix();
  link.translation() -= link.linear() * Vec3(0.0, 0.0, -kShaft);
  return pose;
}

int loadStepsOf(const Eigen::AngleAxisd& turn) {
  Pipeline pipeline(block(), {}, {instrument()});
  const RobotPose stands = turnedBy(Eigen::AngleAxisd::Identity());
  int steps = 0;
  while (pipeline.step(stands).changed && ++steps < 100) {
  }
  return pipeline.step(turnedBy(turn)).substeps;
}

TEST(TurnedTool, TakesTheLoadStepsThatItsSurfaceNeeds) {
  // 0.02 rad 0.4 m away were 8 mm, 8 load steps; the ball's surface goes 0.2 mm.
  EXPECT_LE(loadStepsOf(Eigen::AngleAxisd(0.02, Vec3::UnitZ())), 1) << "about the shaft";
  EXPECT_LE(loadStepsOf(Eigen::AngleAxisd(0.02, Vec3::UnitX())), 1) << "about the ball";
}

TEST(LongestWay, OfAPointIsNeverLongerAndHardlyShorter) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  for (int trial = 0; trial < 1000; ++trial) {
    Pose from = Pose::Identity(), to = Pose::Identity();
    const double angle = trial % 2 == 0 ? 0.05 * any(random) : M_PI * any(random);
    from.linear() = Eigen::AngleAxisd(3.0 * any(random), vector().normalized()).toRotationMatrix();
    to.linear() =
        from.linear() * Eigen::AngleAxisd(angle, vector().normalized()).toRotationMatrix();
    from.translation() = vector();
    const Vec3 corner = vector(), other = vector();
    to.translation() = trial % 3 == 0
                           ? Vec3(from * corner - to.linear() * corner)  // turns about it
                           : Vec3(from.translation() + 0.1 * vector());
    double longest = 0.0;
    for (const double share : {0.0, 0.3, 1.0}) {
      const Vec3 point = corner + share * (other - corner);
      double way = 0.0;
      for (int i = 0; i < 100; ++i) {
        way += (between(from, to, 0.01 * (i + 1)) * point - between(from, to, 0.01 * i) * point)
                   .norm();
      }
      longest = std::max(longest, way);
    }
    const double told = longestWay(from, to, {corner, other});
    EXPECT_GE(told, longest - 1e-12) << trial;
    const double reach = std::max(corner.norm(), other.norm());
    EXPECT_LE(told, longestWay(from, to, reach) + 1e-12) << trial;
    EXPECT_LE(told, longest + angle * angle * reach + 1e-12) << trial;
  }
  const Pose there = at({Vec3(3.0, 0.0, 4.0)}).links.front();
  EXPECT_EQ(longestWay(Pose::Identity(), there, {Vec3::Ones()}), 5.0);
  EXPECT_EQ(longestWay(Pose::Identity(), there, std::vector<Vec3>()), 5.0) << "as of a plane";
}

}  // namespace
}  // namespace robot_tissue::test_way_lengths
