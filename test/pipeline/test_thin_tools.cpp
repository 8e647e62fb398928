// A needle of a fifth of the spacing: between the nodes, in a pit of its own, and out again.
#include <memory>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_thin_tools {
namespace {

constexpr double kThin = 0.0005;              // radius of the needle (m)
constexpr double kDeepest = 0.05 * kSpacing;  // it is in the surface that is shown (m)
constexpr double kIncrement = 0.00025;

// Where its tip comes down from, beside the middle node (m).
class Needle : public ::testing::TestWithParam<Vec3> {
 protected:
  void make(double friction) {
    ToolShape shape;
    shape.type = ToolShape::Type::kCylinder;
    shape.radius = kThin;
    shape.length = 0.05;
    shape.pose.translation().z() = 0.025;  // its tip at the origin
    TissueConfig tissue = block();
    tissue.material.poisson_ratio = 0.45;
    pipeline_ = std::make_unique<Pipeline>(
        tissue, SolverConfig(), std::vector<ToolGeometry>{withFriction(friction, toolOf(shape))});
    place_ = Vec3(0.02, kMiddle, kTop) + GetParam();
    pipeline_->step(at({place_}));
  }

  void go(const Vec3& way) {
    const int count = static_cast<int>(std::lround(way.norm() / kIncrement));
    const Vec3 from = place_;
    for (int step = 1; step <= count; ++step) {
      place_ = from + way * step / count;
      const StepReport& report = pipeline_->step(at({place_}));
      const ForceBalance forces = pipeline_->forceBalance();
      leap_ = std::max(leap_, (forces.tools - last_force_).norm());
      last_force_ = forces.tools;
      deepest_ = std::max(deepest_, report.tools.front().max_penetration);
      most_inverted_ = std::max(most_inverted_, pipeline_->tissue().lastReport().inverted_cells);
      if (report.lost) ++lost_;
      if (pipeline_->tissue().lastReport().status != SolveStatus::kOk) ++not_ok_;
      if (forces.tools.norm() < kLeastForce) continue;
      off_balance_ = std::max(off_balance_, forces.unbalanced().norm() / forces.tools.norm());
    }
  }

  static constexpr double kLeastForce = 0.1;  // N: of which a balance is told

  std::unique_ptr<Pipeline> pipeline_;
  Vec3 place_ = Vec3::Zero();
  Vec3 last_force_ = Vec3::Zero();
  double deepest_ = 0.0, off_balance_ = 0.0;
  double leap_ = 0.0;  // of the force, from one update to the next (N)
  int most_inverted_ = 0, lost_ = 0, not_ok_ = 0;
};

// Nothing but the surface's own slope bears it: at its rim it has no normal of its own.
TEST_P(Needle, WithoutFrictionPressesAPitAndStandsInIt) {
  make(0.0);
  go(Vec3(0.0, 0.0, -0.012));
  EXPECT_LT(deepest_, kDeepest);
  EXPECT_EQ(lost_, 0);
  EXPECT_EQ(not_ok_, 0);
  EXPECT_EQ(most_inverted_, 0);
  EXPECT_LT(leap_, 0.08 * last_force_.norm());
  EXPECT_LT(last_force_.z(), -2.0 * last_force_.head<2>().norm());
}

TEST_P(Needle, DraggedAndDrawnOutNeverGoesThrough) {
  make(0.3);
  go(Vec3(0.0, 0.0, -0.012));
  go(Vec3(0.020, 0.0, 0.0));
  EXPECT_EQ(not_ok_, 0);
  EXPECT_LT(off_balance_, 0.1);
  go(Vec3(0.0, 0.0, 0.014));
  EXPECT_LT(deepest_, kDeepest);
  EXPECT_EQ(lost_, 0);
  EXPECT_EQ(most_inverted_, 0);
  pipeline_->step(at({Vec3(0.0, 0.0, 0.2)}));
  EXPECT_EQ(greatestDisplacement(pipeline_->tissue()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Beside, Needle, ::testing::Values(Vec3::Zero(), Vec3(0.0023, 0.0, 0.0)));

// What a link has far above the tissue, as a wire at its back, is not felt by what it drags below.
TEST(ThinShapes, AboveTheTissueDoNotCount) {
  const auto draggedBy = [](const std::vector<ToolShape>& shapes) {
    ToolGeometry tool = withFriction(0.3, toolOf(shapes.front()));
    tool.links.front().shapes = shapes;
    Pipeline pipeline(block(), SolverConfig(), {tool});
    walk(pipeline, {{0.018, kMiddle, kTop + 0.0061}}, {{0.018, kMiddle, kTop + 0.001}});
    walk(pipeline, {{0.018, kMiddle, kTop + 0.001}}, {{0.025, kMiddle, kTop + 0.001}});
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
    return pipeline.report().tools.front().force_on_tool;
  };
  ToolShape roller;
  roller.type = ToolShape::Type::kCylinder;
  roller.radius = 0.006;
  roller.length = 0.02;
  roller.pose.linear() = Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitX()).toRotationMatrix();
  const Vec3 alone = draggedBy({roller});
  EXPECT_LT(alone.x(), -0.02);
  for (const double radius : {0.001, 0.0001}) {
    ToolShape wire = uprightCylinder(radius, 0.03);
    wire.pose.translation().z() += 0.015;
    EXPECT_LT((draggedBy({roller, wire}) - alone).norm(), 0.01 * alone.norm()) << radius;
  }
}

}  // namespace
}  // namespace robot_tissue::test_thin_tools
