// Tools that slide without friction: nothing but the tissue's slope pushes them aside, whatever
// triangles its surface is made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_sliding_tools {
namespace {

constexpr double kDepth = 0.008;   // m
constexpr double kLength = 0.030;  // m: of the tools, across their way

ToolShape turned(ToolShape shape, double angle, const Vec3& axis, double up) {
  shape.pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  shape.pose.translation().z() = up;
  return shape;
}

ToolShape lyingCylinder() {
  ToolShape cylinder;
  cylinder.type = ToolShape::Type::kCylinder;
  cylinder.radius = 0.006;
  cylinder.length = kLength;
  return turned(cylinder, M_PI / 2.0, Vec3::UnitX(), cylinder.radius);
}

ToolShape boxOnItsEdge() {
  constexpr double kSide = 0.012;
  return turned(boxOf({kSide, kLength, kSide}), M_PI / 4.0, Vec3::UnitY(), kSide / std::sqrt(2.0));
}

// On the tool, where it has come to the block's middle from its left. It goes on from there, so
// that it does not come to rest in a dent of its own.
Vec3 forceInTheMiddle(const ToolShape& shape) {
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(0.0, toolOf(shape))});
  const double y = kMiddle, down = kTop - kDepth;
  walk(pipeline, {{0.018, y, kTop}}, {{0.018, y, down}});
  walk(pipeline, {{0.018, y, down}}, {{kMiddle, y, down}});
  return pipeline.report().tools.front().force_on_tool;
}

// By symmetry the force in the middle of the block is straight up.
TEST(SlidingTools, WithoutFrictionARoundToolIsNotHeldBack) {
  const Vec3 force = forceInTheMiddle(lyingCylinder());
  EXPECT_GT(force.z(), 0.5);
  EXPECT_LT(std::abs(force.x()), 0.08 * force.z());
}

TEST(SlidingTools, WithoutFrictionAnEdgeIsNotHeldBack) {
  const Vec3 force = forceInTheMiddle(boxOnItsEdge());
  EXPECT_GT(force.z(), 0.3);
  EXPECT_LT(std::abs(force.x()), 0.12 * force.z());
}

// A round tool touches the curved surface, not the triangles, which are off it by L^2 / 8 R.
TEST(SlidingTools, ANarrowPressesACoarseLatticeAsAFineOne) {
  const auto force = [](double spacing) {
    Pipeline pipeline(block("elastic", spacing), methodOf("elastic"), {withFriction(0.0, probe())});
    walk(pipeline, -0.001, kDepth);
    return pipeline.report().tools.front().force_on_tool.z();
  };
  const double fine = force(0.5 * kSpacing);
  EXPECT_GT(fine, 0.5);
  EXPECT_NEAR(force(kSpacing), fine, 0.03 * fine);
}

// It touches where the curved surface is deepest in it: a dragged ball is held as smoothly as it is
// round, and stands no deeper than its touches' slack.
TEST(SlidingTools, ADraggedBallIsHeldSmoothlyAndNotLetIn) {
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(0.3, probe())});
  const double y = kMiddle + 0.3 * kSpacing, down = kTop - kDepth + kRadius;
  walk(pipeline, {{0.018, y, kTop + kRadius}}, {{0.018, y, down}});
  walk(pipeline, {{0.018, y, down}}, {{0.018 + kSpacing, y, down}});
  Vec3 before = pipeline.report().tools.front().force_on_tool;
  for (double x = 0.018 + kSpacing; x < kMiddle + kSpacing; x += 0.05 * kSpacing) {
    pipeline.step(at(std::vector<Vec3>{{x, y, down}}));
    const ToolReport& tool = pipeline.report().tools.front();
    EXPECT_LT((tool.force_on_tool - before).norm(), 0.04 * before.norm()) << x;
    EXPECT_LT(tool.max_penetration, 0.035 * kSpacing) << x;
    before = tool.force_on_tool;
  }
}

// Its touches go along it as tissue slides past, and do not pile up where they once were.
TEST(SlidingTools, AnEdgeIsNoDeeperDraggedThanPressed) {
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(0.0, toolOf(boxOnItsEdge()))});
  const double y = kMiddle, down = kTop - 0.004;
  walk(pipeline, {{0.018, y, kTop}}, {{0.018, y, down}});
  const int pressed = pipeline.report().tools.front().contacts;
  for (double x = 0.018; x < kMiddle + kSpacing; x += 0.05 * kSpacing) {
    pipeline.step(at(std::vector<Vec3>{{x, y, down}}));
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << x;
    EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.1 * kSpacing) << x;
    EXPECT_LT(pipeline.report().tools.front().contacts, 2 * pressed + 4) << x;
  }
}

// Force against the way over force up, least and greatest, of a flat tool around the block's
// middle: its edges pass two columns of nodes each.
struct Range {
  double least = 1e9, greatest = -1e9;
};

Range asideOverUp(const ToolShape& shape, double friction) {
  constexpr double kHalf = kSpacing;  // m: of the way that is looked at
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(friction, toolOf(shape))});
  const double down = kTop - 0.006;
  const Vec3 start(kMiddle - kHalf - 0.008, kMiddle, down);
  walk(pipeline, {{start.x(), kMiddle, kTop}}, {start});
  walk(pipeline, {start}, {{kMiddle - kHalf, kMiddle, down}});
  Range range;
  for (int step = -10; step <= 10; ++step) {
    pipeline.step(at(std::vector<Vec3>{{kMiddle + 0.1 * step * kHalf, kMiddle, down}}));
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << step;
    const ToolReport& tool = pipeline.report().tools.front();
    const double ratio = -tool.force_on_tool.x() / tool.force_on_tool.z();
    range.least = std::min(range.least, ratio);
    range.greatest = std::max(range.greatest, ratio);
    EXPECT_LT(tool.max_penetration, 0.1 * kSpacing) << step;
  }
  return range;
}

const ToolShape kFlatTools[] = {boxOf(Vec3::Constant(0.02), Vec3(0.0, 0.0, 0.01)),
                                uprightCylinder(0.010, 0.02)};

TEST(SlidingTools, WithoutFrictionAFlatFaceIsNotHeldBack) {
  for (const ToolShape& shape : kFlatTools) {
    const Range range = asideOverUp(shape, 0.0);
    EXPECT_GT(range.least, -0.03);
    EXPECT_LT(range.greatest, 0.03);
  }
}

TEST(SlidingTools, AFlatFaceIsHeldBackByFrictionAlone) {
  for (const ToolShape& shape : kFlatTools) {
    const Range range = asideOverUp(shape, 0.3);
    EXPECT_GT(range.least, 0.27);
    EXPECT_LT(range.greatest, 0.33);
  }
}

// What a tool drags along by friction is let go in the update in which it leaves.
TEST(SlidingTools, AToolThatLeavesAsideLeavesTheTissueAtRest) {
  for (const double friction : {0.3, 1.0}) {
    for (const double depth : {0.0005, 0.001, 0.004}) {
      for (const double aside : {0.001, 0.004}) {
        Pipeline pipeline(block(), methodOf("elastic"), {withFriction(friction, probe())});
        walk(pipeline, -0.001, depth);
        ASSERT_GT(greatestDisplacement(pipeline.tissue()), 0.0);
        const Vec3 above(kMiddle + aside, kMiddle, kTop + 0.0002);
        const StepReport& report = pipeline.step(at({above + Vec3(0.0, 0.0, kRadius)}));
        ASSERT_EQ(report.tools.front().force_on_tool, Vec3::Zero());
        EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0)
            << friction << " " << depth << " " << aside;
      }
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_sliding_tools
