// Balls that touch less than a spacing's width: they feel a half-space, wherever between the nodes.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "../contact/contact_fixtures.h"
#include "../core/mesh_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_narrow_contacts {
namespace {

constexpr double kBall = 0.02;    // m
constexpr double kModulus = 1e4;  // Pa
constexpr double kPoisson = 0.45;
constexpr double kStep = 0.00025;  // m

// Of a half-space, and of a layer as deep as the block to first order (Dimitriadis et al. 2002).
double forceAt(double depth) {
  const double a = -(1.2876 - 1.4678 * kPoisson + 1.3442 * kPoisson * kPoisson) / (1.0 - kPoisson);
  const double of_layer = 1.0 - 2.0 * a / M_PI * std::sqrt(kBall * depth) / kTop;
  return 4.0 / 3.0 * kModulus / (1.0 - kPoisson * kPoisson) * std::sqrt(kBall) *
         std::pow(depth, 1.5) * of_layer;
}

class NarrowBall : public testing::TestWithParam<std::array<double, 2>> {
 protected:
  NarrowBall() {
    TissueConfig tissue = block();
    tissue.material.poisson_ratio = kPoisson;
    ToolShape ball;
    ball.type = ToolShape::Type::kSphere;
    ball.radius = kBall;
    pipeline_ =
        std::make_unique<Pipeline>(tissue, SolverConfig(), std::vector<ToolGeometry>{toolOf(ball)});
    goTo(-kStep);
  }

  const ToolReport& goTo(double depth) {
    const Vec3 off = kSpacing * Vec3(GetParam()[0], GetParam()[1], 0.0);
    return pipeline_->step(at({Vec3(kMiddle, kMiddle, kTop + kBall - depth) + off})).tools.front();
  }

  std::unique_ptr<Pipeline> pipeline_;
};

// Without the law a quarter too little over a node and half too much elsewhere, half a millimeter
// deep.
TEST_P(NarrowBall, FeelsWhatAHalfSpacePresses) {
  for (int step = 1; step <= 6; ++step) {
    const double depth = kStep * step;
    const ToolReport& tool = goTo(depth);
    if (step == 1) continue;
    EXPECT_NEAR(tool.force_on_tool.z() / forceAt(depth), 1.0, 0.12) << depth << " m";
    EXPECT_LT(tool.max_penetration, 0.01 * kSpacing) << "shown where the ball is";
    EXPECT_EQ(pipeline_->tissue().lastReport().status, SolveStatus::kOk);
  }
}

// As on the tip of a stylus.
TEST_P(NarrowBall, WithAShaftFeelsAsMuch) {
  TissueConfig tissue = block();
  tissue.material.poisson_ratio = kPoisson;
  ToolShape ball, shaft;
  ball.type = ToolShape::Type::kSphere;
  ball.radius = kBall;
  shaft.type = ToolShape::Type::kCylinder;
  shaft.radius = 0.25 * kBall;
  shaft.length = 0.1;
  shaft.pose.translation().z() = 0.05;
  ToolGeometry stylus = toolOf(ball);
  stylus.links.front().shapes.push_back(shaft);
  Pipeline pipeline(tissue, SolverConfig(), {stylus});
  const Vec3 off = kSpacing * Vec3(GetParam()[0], GetParam()[1], 0.0);
  for (int step = -1; step <= 4; ++step) {
    const double depth = kStep * step;
    const double alone = goTo(depth).force_on_tool.z();
    pipeline.step(at({Vec3(kMiddle, kMiddle, kTop + kBall - depth) + off}));
    EXPECT_NEAR(pipeline.report().tools.front().force_on_tool.z(), alone, 0.01 * alone) << depth;
  }
}

// 1.3 to 1.6 spacings in radius, but a quarter of the ball's: by where it is between nodes it felt
// up to 5 % more.
TEST(WideShallowBall, FeelsAsMuchWhereverBetweenNodes) {
  constexpr double kLarge = 0.03, kFirst = 0.0015, kFurther = 0.00025;  // m
  ToolShape ball;
  ball.radius = kLarge;
  TissueConfig tissue = block();
  tissue.material.poisson_ratio = kPoisson;
  std::array<double, 3> least, most;
  least.fill(1e9);
  most.fill(0.0);
  for (const Vec3& off : {Vec3(0.0, 0.0, 0.0), Vec3(0.5, 0.5, 0.0), Vec3(0.5, 0.0, 0.0),
                          Vec3(0.25, 0.1, 0.0), Vec3(0.3, 0.45, 0.0)}) {
    ToolGeometry smooth = toolOf(ball);
    smooth.friction = 0.0;
    Pipeline pipeline(tissue, SolverConfig(), {smooth});
    for (std::size_t depth = 0; depth < least.size(); ++depth) {
      const double down = kFirst + kFurther * static_cast<double>(depth);
      const Vec3 middle = Vec3(kMiddle, kMiddle, kTop + kLarge - down) + kSpacing * off;
      const double force = pipeline.step(at({middle})).tools.front().force_on_tool.z();
      least[depth] = std::min(least[depth], force);
      most[depth] = std::max(most[depth], force);
    }
  }
  for (std::size_t depth = 0; depth < least.size(); ++depth) {
    EXPECT_LT(most[depth], 1.035 * least[depth]) << depth;
  }
}

// However large, and however fast it comes: what its first touch alone would ask for, 2 mm farther
// out, was felt for good, up to six times the force.
TEST(LargeBall, FeelsAsMuchHoweverItComes) {
  constexpr double kDepth = 0.0015;  // m
  for (const double radius : {0.04, 0.06, 0.08}) {
    ToolShape ball;
    ball.radius = radius;
    TissueConfig tissue = block();
    tissue.material.poisson_ratio = kPoisson;
    std::vector<double> forces;
    for (const double first : {-0.0005, 0.0005, 0.0008, 0.0014}) {
      Pipeline pipeline(tissue, SolverConfig(), {toolOf(ball)});
      for (const double depth : {-0.0005, first, kDepth}) {
        pipeline.step(at({Vec3(kMiddle, kMiddle, kTop + radius - depth)}));
      }
      forces.push_back(pipeline.report().tools.front().force_on_tool.z());
    }
    const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
    EXPECT_LT(*most, 1.06 * *least) << radius;
  }
}

// So does the round end of a mesh: without the law by twice as much, and by a third less.
TEST_P(NarrowBall, OfAMeshFeelsAsMuch) {
  TissueConfig tissue = block();
  tissue.material.poisson_ratio = kPoisson;
  std::vector<Eigen::Vector2d> rod = roundEnd(kBall, 0.0, 12);
  rod.emplace_back(kBall, 0.05);
  rod.emplace_back(0.0, 0.05);
  ToolShape shape;
  shape.type = ToolShape::Type::kMesh;
  shape.resource = writeStl("round_rod.stl", revolvedTriangles(rod, 48));
  Pipeline pipeline(tissue, SolverConfig(), {toolOf(shape)});
  const Vec3 off = kSpacing * Vec3(GetParam()[0], GetParam()[1], 0.0);
  for (int step = -1; step <= 6; ++step) {
    const double depth = kStep * step;
    const double ball = goTo(depth).force_on_tool.z();
    pipeline.step(at({Vec3(kMiddle, kMiddle, kTop + kBall - depth) + off}));
    if (step < 2) continue;
    EXPECT_NEAR(pipeline.report().tools.front().force_on_tool.z(), ball, 0.1 * ball) << depth;
  }
}

// A shaft as thick as its ball is not felt as a flat end, nor is more felt than with the ball
// alone, until the shaft touches.
TEST(Capsule, FeelsAsItsBall) {
  constexpr double kTip = 0.005, kFine = 0.005;  // m
  ToolShape ball, shaft;
  ball.radius = kTip;
  shaft.type = ToolShape::Type::kCylinder;
  shaft.radius = kTip;
  shaft.length = 0.03;
  shaft.pose.translation().z() = 0.015;
  ToolGeometry capsule = toolOf(ball);
  capsule.links.front().shapes.push_back(shaft);
  Pipeline whole(block("elastic", kFine), SolverConfig(), {capsule});
  Pipeline alone(block("elastic", kFine), SolverConfig(), {toolOf(ball)});
  for (int step = -1; step <= 16; ++step) {
    const RobotPose pose = at({Vec3(0.0513, 0.0505, kTop + kTip - 0.0003 * step)});
    whole.step(pose);
    const double expected = alone.step(pose).tools.front().force_on_tool.z();
    EXPECT_NEAR(whole.report().tools.front().force_on_tool.z(), expected, 1e-3 * expected) << step;
  }
}

// A ball at the lower edge of a slab whose top a load holds: up to 2.6 times as much, as what is
// held was taken to give way. Deeper, where edges have no law, either hangs on the steps to there.
TEST(BallBesideALoad, FeelsAsBesideWhatIsFixed) {
  constexpr double kThick = 2.0 * kSpacing, kTip = 0.7 * kSpacing;  // m
  TissueConfig slab = block();
  slab.shape.max().z() = kThick;
  slab.fixed.clear();
  const Box top = {Vec3(-1.0, -1.0, kThick - 1e-6), Vec3(1.0, 1.0, 1.0)};
  TissueConfig fixed_slab = slab;
  fixed_slab.fixed.push_back(top);
  ToolShape ball;
  ball.radius = kTip;
  Pipeline held(slab, SolverConfig(), {withFriction(0.0, toolOf(ball))});
  Pipeline fixed(fixed_slab, SolverConfig(), {withFriction(0.0, toolOf(ball))});
  PatchConfig patch;
  patch.name = "held";
  patch.box = top;
  patch.displacement = {{0.0, 0.0, 0.0}};
  held.load({1, {patch}});
  const Vec3 inwards = Vec3(1.0, 0.0, 1.0).normalized();
  for (int step = -2; step <= 7; ++step) {
    const double depth = 0.05 * kSpacing * step;
    const RobotPose pose = at({Vec3(0.0, kMiddle, 0.0) - (kTip - depth) * inwards});
    const double expected = fixed.step(pose).tools.front().force_on_tool.norm();
    EXPECT_NEAR(held.step(pose).tools.front().force_on_tool.norm(), expected, 0.25 * expected)
        << depth << " m";
  }
}

// Balls between a node that a load holds, or that is fixed, and the next one: as the table of point
// loads had no say there, they were told 4 to 8 times Hertz's force. At a quarter of the spacing it
// is 1.07 to 1.17 down to 0.2 spacings.
TEST(BallBesideALoad, OnAFlatSurfaceFeelsAHalfSpace) {
  constexpr double kTip = 0.7 * kSpacing;  // m
  for (const bool is_fixed : {false, true}) {
    TissueConfig tissue = block();
    tissue.material.poisson_ratio = kPoisson;
    const Box half = {Vec3(-1.0, -1.0, kTop - 1e-6), Vec3(kMiddle + 1e-6, 1.0, 1.0)};
    if (is_fixed) tissue.fixed.push_back(half);
    ToolShape ball;
    ball.radius = kTip;
    for (const double off : {0.6, 0.8, 1.0}) {
      Pipeline pipeline(tissue, SolverConfig(), {withFriction(0.0, toolOf(ball))});
      PatchConfig patch;
      patch.name = "held";
      patch.box = half;
      patch.displacement = {{0.0, 0.0, 0.0}};
      if (!is_fixed) pipeline.load({1, {patch}});
      for (const double depth : {-0.1, -0.05, 0.05, 0.1, 0.2}) {
        const Vec3 middle(kMiddle, kMiddle, kTop + kTip);
        const RobotPose pose = at({middle + kSpacing * Vec3(off, 0.3, -depth)});
        const double told = pipeline.step(pose).tools.front().force_on_tool.norm();
        const double hertz = 4.0 / 3.0 * kModulus / (1.0 - kPoisson * kPoisson) * std::sqrt(kTip) *
                             std::pow(std::max(0.0, depth) * kSpacing, 1.5);
        EXPECT_NEAR(told, 1.1 * hertz, 0.2 * hertz) << off << ", " << depth;
      }
    }
  }
}

// A wall of 2.2 spacings, a mesh, on a table: it was told up to twice its force, beside the edge
// eight times, and at the corner no shape followed. At a quarter of the spacing it is 1.08 and 1.13
// times Hertz's, 0.80 and 0.82 beside the edge.
TEST(BallOnAWall, FeelsTheTableBehindItOnce) {
  constexpr double kThick = 2.2 * kSpacing, kSide = 10.0 * kSpacing, kTip = 0.7 * kSpacing;  // m
  TissueConfig wall = block();
  wall.fixed.clear();
  wall.material.poisson_ratio = kPoisson;
  wall.gravity = Vec3(0.0, 0.0, -9.81);
  wall.shape.max() = Vec3(kSide, kSide, kThick);
  wall.mesh = std::make_shared<TriangleMesh>(boxMesh(Vec3::Zero(), wall.shape.max()));
  ToolShape ball;
  ball.radius = kTip;
  const SupportConfig table = {"table", planeOf(true), 0.3};
  for (const Vec3& place : {Vec3(5.0, 5.3, 0.0), Vec3(0.4, 5.3, 0.0), Vec3(0.4, 0.4, 0.0)}) {
    Pipeline pipeline(wall, SolverConfig(), {withFriction(0.0, toolOf(ball))}, {table});
    pipeline.settle();
    const double most = place.x() < 1.0 ? 1.45 : 1.3;
    for (const double depth : {-0.1, -0.05, 0.05, 0.1, 0.2, 0.35}) {
      const Vec3 middle(0.0, 0.0, kThick + kTip - depth * kSpacing);
      pipeline.step(at({middle + kSpacing * place}));
      EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
      if (depth < 0.1) continue;
      const double hertz = 4.0 / 3.0 * kModulus / (1.0 - kPoisson * kPoisson) * std::sqrt(kTip) *
                           std::pow(depth * kSpacing, 1.5);
      const double told = pipeline.report().tools.front().force_on_tool.norm();
      EXPECT_GT(told, 0.6 * hertz) << place.transpose() << ", " << depth;
      EXPECT_LT(told, most * hertz) << place.transpose() << ", " << depth;
    }
  }
}

// Down to a ball's own size and beyond.
TEST_P(NarrowBall, IsNotLetThroughHoweverSmall) {
  for (const double radius : {0.1 * kSpacing, 0.3 * kSpacing, 0.51 * kSpacing, 0.8 * kSpacing}) {
    ToolShape ball;
    ball.type = ToolShape::Type::kSphere;
    ball.radius = radius;
    Pipeline pipeline(block(), SolverConfig(), {toolOf(ball)});
    const Vec3 off = kSpacing * Vec3(GetParam()[0], GetParam()[1], 0.0);
    for (int step = -1; step <= 24; ++step) {
      pipeline.step(at({Vec3(kMiddle, kMiddle, kTop + radius - kStep * step) + off}));
      EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.1 * kSpacing) << radius;
    }
    EXPECT_GT(pipeline.report().tools.front().force_on_tool.z(), 0.05) << radius;
  }
}

TEST_P(NarrowBall, LeavesNothingBehind) {
  for (int step = 1; step <= 4; ++step) goTo(kStep * step);
  for (int step = 3; step >= -4; --step) goTo(kStep * step);
  EXPECT_EQ(pipeline_->report().tools.front().force_on_tool.norm(), 0.0);
  EXPECT_EQ(greatestDisplacement(pipeline_->tissue()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Places, NarrowBall,
                         testing::Values(std::array<double, 2>{0.0, 0.0},
                                         std::array<double, 2>{0.5, 0.5},
                                         std::array<double, 2>{0.5, 0.0},
                                         std::array<double, 2>{0.33, 0.67},
                                         std::array<double, 2>{0.25, 0.1}));

// A finger on a layer as thick as a spacing, over what is ten times as stiff, beside one of half
// that spacing: the half-space's dent would be the layer's own, and the force half as much again.
TEST(BallOnALayer, IsNotTakenToBeOnAHalfSpace) {
  constexpr double kFinger = 0.006;  // m
  const auto force = [](double spacing) {
    TissueConfig tissue = block("elastic", spacing);
    Region stiff;
    stiff.name = "stiff";
    stiff.box = {Vec3::Zero(), Vec3(kWidth, kWidth, kTop - kSpacing)};
    stiff.material = tissue.material;
    stiff.material.young_modulus = 1e5;
    tissue.regions.push_back(stiff);
    ToolShape ball;
    ball.radius = kFinger;
    Pipeline pipeline(tissue, SolverConfig(), {toolOf(ball)});
    for (double depth = -0.0005; depth < 0.0032; depth += 0.0005) {
      pipeline.step(at({Vec3(kMiddle, kMiddle, kTop + kFinger - depth)}));
    }
    return pipeline.report().tools.front().force_on_tool.z();
  };
  const double fine = force(0.5 * kSpacing);
  EXPECT_NEAR(force(kSpacing), fine, 0.2 * fine);
}

// A light touch, for which all gaps were small enough to be let be.
TEST(LightTouch, IsFeltAlikeWhereverTheBallCameFrom) {
  constexpr double kSmall = 0.005, kHeight = 0.03, kDepth = 0.0002;  // m
  TissueConfig tissue = block("elastic", 0.005);
  tissue.shape.max() = Vec3(0.06, 0.06, kHeight);
  tissue.material.poisson_ratio = 0.3;
  ToolShape ball;
  ball.type = ToolShape::Type::kSphere;
  ball.radius = kSmall;
  Pipeline pipeline(tissue, SolverConfig(), {withFriction(0.0, toolOf(ball))});
  const auto force_at = [&](double depth) {
    pipeline.step(at({Vec3(0.0278544, 0.0243124, kHeight + kSmall - depth)}));
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << depth;
    return pipeline.report().tools.front().force_on_tool.z();
  };
  force_at(-0.005);
  const double first = force_at(kDepth);
  for (const double other : {0.00012, 0.00024, 0.0003, -0.0002}) {
    force_at(other);
    EXPECT_NEAR(force_at(kDepth), first, 0.2 * first) << other << " m";
  }
}

class FirstTouch : public testing::Test {
 protected:
  struct Felt {
    double force = 0.0;  // N
    int iterations = 0;
  };

  // A ball of a spacing's size comes down between nodes.
  static std::vector<Felt> stepsDown(double friction) {
    constexpr double kSize = 0.01, kHeight = 0.08;  // m
    TissueConfig tissue = block("elastic", kSize);
    tissue.shape.max() = Vec3(0.12, 0.08, kHeight);
    tissue.material.poisson_ratio = kPoisson;
    ToolShape ball;
    ball.radius = kSize;
    Pipeline pipeline(tissue, SolverConfig(), {withFriction(friction, toolOf(ball))});
    std::vector<Felt> felt;
    for (const double depth : {-0.0002, -0.00007, 0.00006, 0.00019, 0.00032}) {
      pipeline.step(at({Vec3(0.063, 0.028, kHeight + kSize - depth)}));
      felt.push_back({pipeline.report().tools.front().force_on_tool.z(),
                      pipeline.tissue().lastReport().iterations});
    }
    return felt;
  }
};

// What is near the ball stuck to it, too, and was drawn along: a first touch without a force.
TEST_F(FirstTouch, DrawsAlongNothingThatIsOnlyNear) {
  const std::vector<Felt> rough = stepsDown(0.3), smooth = stepsDown(0.0);
  for (std::size_t step = 2; step < rough.size(); ++step) {
    EXPECT_GT(smooth[step].force, 0.0005);
    EXPECT_NEAR(rough[step].force, smooth[step].force, 0.12 * smooth[step].force) << step;
  }
}

// 39 iterations in the second, while its recess was that of the first.
TEST_F(FirstTouch, TakesFewIterationsAlsoInTheLoadStepAfterIt) {
  for (const double friction : {0.0, 0.3}) {
    for (const Felt& felt : stepsDown(friction)) EXPECT_LE(felt.iterations, 25) << friction;
  }
}

}  // namespace
}  // namespace robot_tissue::test_narrow_contacts
