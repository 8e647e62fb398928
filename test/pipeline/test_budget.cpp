// Updates that end before the shape is in balance: solver.max_ms. The budgets are so short, or so
// long, that it does not matter how fast the machine is.
#include <limits>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_budget {
namespace {

constexpr double kTooShort = 1e-3;  // ms: one solve, with one cycle

Pipeline bounded(double max_ms, const ToolGeometry& tool = withFriction(0.3, probe())) {
  SolverConfig solver = methodOf("elastic");
  solver.max_ms = max_ms;
  return {block(), solver, {tool}};
}

double force(const Pipeline& pipeline) {
  return pipeline.report().tools.front().force_on_tool.norm();
}

// Presses to 4 mm and drags by 10 mm; tells each step.
template <class Each>
void pressAndDrag(Pipeline& pipeline, const Each& each) {
  for (int step = -2; step <= 80; ++step) {
    const double gone = 0.00025 * step;
    const double depth = std::min(gone, 0.004);
    pipeline.step(pressed(depth, kMiddle - 0.005 + 0.625 * std::max(0.0, gone - 0.004)));
    each();
  }
}

TEST(Budget, WithoutTimeAStepMakesOneSolveAndSaysSo) {
  Pipeline pipeline = bounded(kTooShort);
  pipeline.setBudget(1e-3 * kTooShort);
  int late = 0;
  pressAndDrag(pipeline, [&] {
    EXPECT_LE(pipeline.tissue().lastReport().iterations, 1);
    EXPECT_LE(pipeline.report().substeps, 1);
    late += pipeline.report().late ? 1 : 0;
    EXPECT_EQ(pipeline.report().late, pipeline.tissue().lastReport().status == SolveStatus::kLate);
  });
  EXPECT_GT(late, 40);
}

// Nothing sticks to where it was before its jump.
TEST(Budget, ToolThatJumpsInIsMetAsOneThatComes) {
  Pipeline pipeline = bounded(kTooShort);
  pipeline.setBudget(1e-3 * kTooShort);
  pipeline.step(pressed(-0.002));
  pipeline.step(at({Vec3(5.0, 5.0, 5.0)}));
  int updates = 0;
  do {
    pipeline.step(pressed(0.005));
    EXPECT_LT(force(pipeline), 1.0);
    ++updates;
  } while (pipeline.report().changed && updates < 400);
  EXPECT_LT(updates, 400);
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
  Pipeline came = bounded(0.0);
  walk(came, -0.002, 0.005);
  EXPECT_NEAR(force(pipeline), force(came), 0.06 * force(came));
}

TEST(Budget, ThatIsLongChangesNothing) {
  Pipeline patient = bounded(1e6), unbounded = bounded(0.0);
  patient.setBudget(1e3);
  std::vector<Vec3> told, wanted;
  pressAndDrag(patient, [&] {
    EXPECT_FALSE(patient.report().late);
    told.push_back(patient.report().tools.front().force_on_tool);
  });
  pressAndDrag(unbounded,
               [&] { wanted.push_back(unbounded.report().tools.front().force_on_tool); });
  ASSERT_EQ(told.size(), wanted.size());
  for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], wanted[i]);
}

TEST(Budget, ToolIsNotLetThroughHoweverLateItIs) {
  Pipeline pipeline = bounded(kTooShort);
  pipeline.setBudget(1e-3 * kTooShort);
  pressAndDrag(pipeline, [&] {
    EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.15 * kSpacing);
  });
}

// Of the greatest force; unbounded it changes by less than an eighth of it from step to step. One
// cycle in a step leaves the more, the more planes turn with the surface.
TEST(Budget, LateWrenchesFollowWithoutJumps) {
  Pipeline hurried = bounded(kTooShort), patient = bounded(0.0);
  hurried.setBudget(1e-3 * kTooShort);
  std::vector<Vec3> told, wanted;
  const auto force_of = [](const Pipeline& pipeline) {
    return pipeline.report().tools.front().force_on_tool;
  };
  pressAndDrag(hurried, [&] { told.push_back(force_of(hurried)); });
  pressAndDrag(patient, [&] { wanted.push_back(force_of(patient)); });
  double greatest = 0.0;
  for (const Vec3& each : wanted) greatest = std::max(greatest, each.norm());
  for (std::size_t i = 1; i < told.size(); ++i) {
    EXPECT_LT((told[i] - told[i - 1]).norm(), 0.35 * greatest) << "step " << i;
    EXPECT_LT((told[i] - wanted[i]).norm(), 0.25 * greatest) << "step " << i;
  }
}

TEST(Budget, WhatIsLeftIsCarriedOnWhileTheToolStands) {
  Pipeline pipeline = bounded(kTooShort), patient = bounded(0.0);
  pipeline.setBudget(1e-3 * kTooShort);
  const double far = kMiddle + 0.0125;  // more than one cycle can follow
  for (Pipeline* each : {&pipeline, &patient}) {
    pressAndDrag(*each, [] {});
    each->step(pressed(0.004, far));
  }
  const RobotPose stands = pressed(0.004, far);
  EXPECT_FALSE(pipeline.stillPose().has_value());
  int steps = 0;
  while (pipeline.step(stands).changed && ++steps < 300) {
  }
  EXPECT_LT(steps, 300);
  EXPECT_FALSE(pipeline.report().late);
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
  EXPECT_TRUE(pipeline.stillPose().has_value());
  EXPECT_NEAR(force(pipeline), force(patient), 0.05 * force(patient));
  EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.05 * kSpacing);
}

// It comes to rest up to a twentieth off, as what is cut short tells no force.
TEST(Budget, DrivenToolMeetsItsForceInLaterSteps) {
  for (const double wanted : {0.11, 0.2, 0.32}) {  // N
    Pipeline pipeline = bounded(kTooShort);
    pipeline.setBudget(1e-3 * kTooShort);
    pipeline.step(pressed(-0.001));
    pipeline.push(0, Vec3(0.0, 0.0, -wanted));
    int steps = 0;
    do {
      pipeline.step(pressed(-0.001));
      EXPECT_LE(pipeline.report().substeps, 3) << "the bound holds for all corrections together";
    } while (pipeline.report().changed && ++steps < 500);
    EXPECT_LT(steps, 500);
    EXPECT_NEAR(pipeline.report().tools.front().force_on_tool.z(), wanted, 0.05 * wanted);
  }
}

}  // namespace
}  // namespace robot_tissue::test_budget
