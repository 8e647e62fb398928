// Load steps of so many iterations at most (solver.max_iterations): counted, so that a slip is
// followed alike on every machine.
#include "pipeline_fixtures.h"

namespace robot_tissue::test_max_iterations {
namespace {

constexpr int kMost = 24;
constexpr double kDepth = 0.008;  // m
constexpr double kWay = 0.020;    // m, of the drag

// A box on its edge, off which tissue slips once a spacing.
ToolGeometry edge() {
  ToolShape box = boxOf(Vec3::Constant(0.02));
  box.pose.linear() = Eigen::AngleAxisd(0.25 * M_PI, Vec3::UnitY()).toRotationMatrix();
  box.pose.translation().z() = 0.01 * std::sqrt(2.0);
  return withFriction(0.3, toolOf(box));
}

class Dragged {
 public:
  explicit Dragged(int most) { pipeline.setMostIterations(most); }

  Pipeline pipeline{block(), methodOf("elastic"), {edge()}};
};

RobotPose edgeAt(double x, double depth) { return at({Vec3(x, kMiddle + 0.0011, kTop - depth)}); }

// Presses the edge in and drags it, 0.25 mm a step; tells each step.
template <class Each>
void pressAndDrag(Pipeline& pipeline, const Each& each) {
  for (int step = -4; step <= 112; ++step) {
    const double gone = 0.00025 * step;
    pipeline.step(edgeAt(0.0213 + std::max(0.0, gone - kDepth), std::min(gone, kDepth)));
    each();
  }
}

Vec3 force(const Pipeline& pipeline) { return pipeline.report().tools.front().force_on_tool; }

std::vector<Vec3> forcesOfDrag(int most) {
  Dragged dragged(most);
  Pipeline& pipeline = dragged.pipeline;
  std::vector<Vec3> forces;
  pressAndDrag(pipeline, [&] { forces.push_back(force(pipeline)); });
  return forces;
}

double greatestOf(const std::vector<Vec3>& forces) {
  double greatest = 0.0;
  for (const Vec3& each : forces) greatest = std::max(greatest, each.norm());
  return greatest;
}

TEST(MaxIterations, NoLoadStepMakesMore) {
  Dragged one(0), other(kMost);
  Pipeline &free = one.pipeline, &bounded = other.pipeline;
  int longest = 0;
  pressAndDrag(free, [&] { longest = std::max(longest, free.tissue().lastReport().iterations); });
  ASSERT_GT(longest, kMost) << "nothing slips that would have to be bounded";
  pressAndDrag(bounded, [&] { EXPECT_LE(bounded.tissue().lastReport().iterations, kMost); });
}

TEST(MaxIterations, WhatStillSettlesIsLateInBalanceAndHardlyDeeper) {
  Dragged dragged(kMost);
  Pipeline& pipeline = dragged.pipeline;
  int settling = 0;
  pressAndDrag(pipeline, [&] {
    const StepReport& report = pipeline.report();
    if (report.too_fast || !report.late) return;
    ++settling;
    EXPECT_TRUE(pipeline.hasArrived()) << "its wrench is that of the pose";
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kLate);
    EXPECT_LE(report.tools.front().max_penetration, 0.1001 * kSpacing);
    const ForceBalance forces = pipeline.forceBalance();
    EXPECT_LT(forces.unbalanced().norm(), 0.05 * forces.tools.norm());
  });
  EXPECT_GT(settling, 0);
  EXPECT_LT(settling, 40);
}

TEST(MaxIterations, ToolThatStandsSettles) {
  Dragged dragged(kMost);
  Pipeline& pipeline = dragged.pipeline;
  bool any = false;
  for (int step = -4; step <= 112; ++step) {
    const double gone = 0.00025 * step;
    const RobotPose pose = edgeAt(0.0213 + std::max(0.0, gone - kDepth), std::min(gone, kDepth));
    pipeline.step(pose);
    if (!pipeline.report().late) continue;
    any = true;
    int updates = 0;
    while (pipeline.isLate() && ++updates < 30) pipeline.step(pose);
    EXPECT_LT(updates, 30);
    EXPECT_TRUE(pipeline.hasArrived());
    EXPECT_TRUE(pipeline.stillPose().has_value());
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
    EXPECT_FALSE(pipeline.step(pose).changed) << "a still scene asks for nothing";
  }
  EXPECT_TRUE(any);
}

// What the supports alone touch, as no tool does any more, settles likewise.
TEST(MaxIterations, TissueThatAToolLeftSettlesOnItsSupport) {
  TissueConfig tissue = block();
  tissue.shape.max() = Vec3(0.03, 0.03, 0.02);
  tissue.fixed.clear();
  tissue.gravity = Vec3(0.0, 0.0, -9.81);
  tissue.material.young_modulus = 2e3;
  bool any = false;
  for (const double x : {0.015, 0.02}) {
    Pipeline pipeline(tissue, {}, {withFriction(0.6, probe())}, {{"table", planeOf(true), 0.3}});
    pipeline.settle();
    pipeline.setMostIterations(4);
    Vec3 center(x, 0.015, 0.021 + kRadius);
    for (const double way : {-0.01, 0.015}) {
      const Vec3 end = center + way * Vec3::UnitZ();
      walk(pipeline, {center}, {end}, way < 0.0 ? 0.0008 : 0.003);
      center = end;
    }
    any = any || pipeline.isLate();
    for (int update = 0; update < 6; ++update) pipeline.step(at({center}));
    EXPECT_FALSE(pipeline.isLate()) << x;
    EXPECT_TRUE(pipeline.stillPose().has_value()) << x;
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << x;
  }
  EXPECT_TRUE(any);
}

// What is late is off by what is left to settle. Slips are to be found a step or two later.
TEST(MaxIterations, ForcesAreThoseWithoutABoundButForSlips) {
  const std::vector<Vec3> bounded = forcesOfDrag(kMost), wanted = forcesOfDrag(0);
  const double greatest = greatestOf(wanted);
  int off = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if ((bounded[i] - wanted[i]).norm() > 0.06 * greatest) ++off;
  }
  EXPECT_LT(off, static_cast<int>(wanted.size()) / 6);
}

TEST(MaxIterations, SameBitsEachTime) {
  const std::vector<Vec3> one = forcesOfDrag(kMost), other = forcesOfDrag(kMost);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i], other[i]) << i;
}

TEST(MaxIterations, ThatAreManyChangeNothing) {
  const std::vector<Vec3> one = forcesOfDrag(1000000), other = forcesOfDrag(0);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i], other[i]) << i;
}

// A load step that is under way holds up no tool that passes the tissue by.
TEST(MaxIterations, ToolsThatTouchNothingAreNeverBehind) {
  Pipeline pipeline(block(), methodOf("elastic"), {edge(), probe("other")});
  pipeline.setMostIterations(4);
  int held_up = 0;
  for (int step = 0; step <= 80; ++step) {
    const double gone = 0.0005 * step;
    RobotPose pose = edgeAt(0.0213 + std::max(0.0, gone - kDepth), std::min(gone, kDepth));
    pose.links.push_back(Pose::Identity());
    pose.links.back().translation() = Vec3(0.001 * step, kMiddle, 0.2);
    const StepReport& report = pipeline.step(pose);
    held_up += report.too_fast ? 1 : 0;
    EXPECT_EQ(std::count(report.behind.begin(), report.behind.end(), 1U), 0) << step;
    EXPECT_EQ(pipeline.pose()->links.back().translation(), pose.links.back().translation()) << step;
  }
  EXPECT_GT(held_up, 0);
}

// A load step that is gone on with while there is no pose takes the tool along.
TEST(MaxIterations, WithoutAPoseTheToolIsToldWhereItCameTo) {
  Dragged dragged(8);
  Pipeline& pipeline = dragged.pipeline;
  int went_on = 0;
  for (int step = 0; step <= 80; ++step) {
    const double gone = 0.0005 * step;
    const RobotPose pose = edgeAt(0.0213 + std::max(0.0, gone - kDepth), std::min(gone, kDepth));
    pipeline.step(pose);
    if (!pipeline.report().too_fast) continue;
    ASSERT_FALSE(pipeline.hasArrived());
    pipeline.carryOn();
    if (!pipeline.hasArrived()) continue;
    ++went_on;
    EXPECT_EQ(pipeline.pose()->links.front().matrix(), pose.links.front().matrix()) << step;
  }
  EXPECT_GT(went_on, 0);
}

// A force is met to half a percent by contacts that are settled.
TEST(MaxIterations, DrivenToolMeetsItsForce) {
  Dragged dragged(kMost);
  Pipeline& pipeline = dragged.pipeline;
  pipeline.step(edgeAt(kMiddle, -0.001));
  const double wanted = 0.5;  // N
  pipeline.push(0, Vec3(0.0, 0.0, -wanted));
  int updates = 0;
  while (pipeline.step(edgeAt(kMiddle, -0.001)).changed && ++updates < 200) {
  }
  EXPECT_LT(updates, 200);
  EXPECT_FALSE(pipeline.report().late);
  EXPECT_NEAR(force(pipeline).z(), wanted, 0.01 * wanted);
}

// What the last way came to, late or lost, is no matter for the next one.
TEST(MaxIterations, AfterAResetItGoesAsTheFirstTime) {
  Dragged once(8), again(8);
  std::vector<Vec3> first, second;
  pressAndDrag(once.pipeline, [&] { first.push_back(force(once.pipeline)); });
  for (int step = -4; !again.pipeline.report().too_fast; ++step) {
    ASSERT_LT(step, 60) << "no way is too long to be followed";
    again.pipeline.step(edgeAt(0.0213 + 0.0002 * step, 0.0009 * step));
  }
  again.pipeline.reset();
  pressAndDrag(again.pipeline, [&] { second.push_back(force(again.pipeline)); });
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace robot_tissue::test_max_iterations
