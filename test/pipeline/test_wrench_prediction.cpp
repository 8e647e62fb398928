// Wrenches between solves.
#include <gtest/gtest.h>

#include <functional>

#include "pipeline_fixtures.h"
#include "robot_tissue/pipeline/wrench_prediction.h"

namespace robot_tissue::test_wrench_prediction {
namespace {

constexpr double kArm = 0.01;  // m

ToolWrench wrenchOf(const Pipeline& pipeline) {
  const Eigen::Matrix3d turn = pipeline.pose()->links.front().linear();
  const ToolReport& tool = pipeline.report().tools.front();
  return {turn * tool.force_on_tool, turn * tool.torque_on_tool};
}

Pose poseAt(const Vec3& origin) {
  Pose pose = Pose::Identity();
  pose.translation() = origin;
  return pose;
}

SolverConfig exact() {
  SolverConfig solver;
  solver.tolerance = 1e-3;
  return solver;
}

struct Ahead {
  double predicted = 0.0, held = 0.0;  // root of the mean square error, of the greatest force
};

// Of a force half a millimeter ahead, as predicted and as the last one solved, along a way that is
// told by its length; once it has gone for `from` updates.
Ahead errorAhead(const std::function<Vec3(double)>& way, int updates, int from) {
  constexpr double kStep = 2.5e-4;  // m
  constexpr int kStepsAhead = 2;
  Pipeline pipeline(block(), exact(), {withFriction(0.0, probe())});
  WrenchPrediction prediction(kArm);
  std::vector<Vec3> predicted, solved;
  double greatest = 0.0;
  Ahead error;
  for (int update = 0; update < updates; ++update) {
    const Vec3 place = way(kStep * update);
    pipeline.step(at({place}));
    const ToolWrench wrench = wrenchOf(pipeline);
    greatest = std::max(greatest, wrench.force.norm());
    if (update >= from) {
      const std::size_t then = static_cast<std::size_t>(update - kStepsAhead);
      error.predicted += (predicted[then] - wrench.force).squaredNorm();
      error.held += (solved[then] - wrench.force).squaredNorm();
    }
    prediction.learn(poseAt(place), wrench);
    solved.push_back(wrench.force);
    predicted.push_back(prediction.at(poseAt(way(kStep * (update + kStepsAhead)))).force);
  }
  error.predicted = std::sqrt(error.predicted / (updates - from)) / greatest;
  error.held = std::sqrt(error.held / (updates - from)) / greatest;
  return error;
}

Vec3 above(double depth) { return pressed(depth).links.front().translation(); }

TEST(WrenchPrediction, FollowsALinearContactOnceItsWaysAreKnown) {
  Eigen::Matrix3d stiffness;
  stiffness << 50, 0, 5, 0, 60, 0, 5, 0, 120;
  const auto wrench = [&](const Vec3& place) {
    return ToolWrench{Vec3(0, 0, 1) - stiffness * place, Vec3::Zero()};
  };
  WrenchPrediction prediction(kArm);
  Vec3 place = Vec3::Zero();
  prediction.learn(poseAt(place), wrench(place));
  for (int round = 0; round < 20; ++round) {
    for (int axis = 0; axis < 3; ++axis) {
      place[axis] = (round % 2 == 0 ? 1e-3 : -1e-3);
      prediction.learn(poseAt(place), wrench(place));
    }
  }
  const Vec3 way(2e-4, -3e-4, 1e-4);
  const Vec3 change = prediction.at(poseAt(place + way)).force - wrench(place).force;
  EXPECT_LT((change + stiffness * way).norm(), 0.02 * (stiffness * way).norm());
}

TEST(WrenchPrediction, FollowsATurn) {
  WrenchPrediction prediction(kArm);
  const auto turned = [](double angle) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    return pose;
  };
  const auto wrench = [](double angle) {
    return ToolWrench{Vec3(0.0, 0.0, 1.0), Vec3(0.0, -0.05 * angle, 0.0)};
  };
  for (int step = 0; step < 20; ++step) prediction.learn(turned(0.02 * step), wrench(0.02 * step));
  const double change = prediction.at(turned(0.40)).torque.y() - wrench(0.38).torque.y();
  EXPECT_NEAR(change, -0.05 * 0.02, 0.1 * 0.05 * 0.02);
}

TEST(WrenchPrediction, IsFarBetterThanTheLastWrenchWhereATipIsPressed) {
  const Ahead error = errorAhead([](double way) { return above(way - 0.001); }, 60, 12);
  EXPECT_LT(error.predicted, 0.015);
  EXPECT_LT(error.predicted, 0.4 * error.held);
}

// Round a circle at one depth the force hardly changes but for the steps of the lattice.
TEST(WrenchPrediction, IsNoWorseThanTheLastWrenchWhereNothingIsToBeForetold) {
  const auto circle = [](double way) {
    constexpr double kDepth = 0.006, kTurn = 0.004;  // m
    if (way < kDepth) return above(way);
    const double angle = (way - kDepth) / kTurn;
    return Vec3(above(kDepth) + kTurn * Vec3(std::sin(angle), 1.0 - std::cos(angle), 0.0));
  };
  const Ahead error = errorAhead(circle, 200, 60);
  EXPECT_LT(error.predicted, 0.03);
  EXPECT_LT(error.predicted, 1.25 * error.held);
}

TEST(WrenchPrediction, WhatTouchesNothingFeelsNothingAndNoneIsPulled) {
  constexpr double kStiffness = 2000.0, kTouch = 5e-4;  // N/m, m
  const auto at_depth = [](double depth) { return poseAt(Vec3(0.0, 0.0, -depth)); };
  WrenchPrediction prediction(kArm);
  EXPECT_TRUE(prediction.at(at_depth(0.0)).force.isZero());
  for (int step = 1; step <= 40; ++step) {
    const double depth = kTouch + 2e-5 * (step <= 20 ? step : 40 - step + 1);
    prediction.learn(at_depth(depth),
                     {Vec3(0.0, 0.0, kStiffness * (depth - kTouch)), Vec3::Zero()});
  }
  EXPECT_GT(prediction.at(at_depth(kTouch + 1e-4)).force.z(), 0.06);
  EXPECT_TRUE(prediction.at(at_depth(kTouch - 4e-4)).force.isZero());
  prediction.learn(at_depth(0.0), {});
  EXPECT_TRUE(prediction.at(at_depth(kTouch + 1e-4)).force.isZero());
}

// A force that grows by 193 N/m as the tool goes in, up to 0.88 N.
class PressedOn {
 public:
  explicit PressedOn(WrenchPrediction& prediction) : prediction_(prediction) {
    for (int step = 0; step < 100; ++step) press(3e-5, force_ + 0.0058);
  }
  void press(double step, double force) {
    depth_ += step;
    force_ = force;
    prediction_.learn(poseAt(Vec3(0.0, 0.0, -depth_)), {Vec3(0.0, 0.0, force), Vec3::Zero()});
  }
  double deeper(double way) const {
    return prediction_.at(poseAt(Vec3(0.0, 0.0, -depth_ - way))).force.z();
  }
  double force() const { return force_; }

 private:
  WrenchPrediction& prediction_;
  double depth_ = 0.0, force_ = 0.3;
};

// As where tissue slips or is cut: that is no stiffness.
TEST(WrenchPrediction, AForceThatFallsWithinASmallStepIsNotForetoldAsGreat) {
  for (const double step : {1e-6, 1e-5, 5e-5}) {
    for (const double after : {0.02, 0.04, 0.2}) {
      WrenchPrediction prediction(kArm);
      PressedOn pressed(prediction);
      const double before = pressed.force();
      pressed.press(step, after);
      for (const double way : {-5e-4, 5e-4}) EXPECT_LT(pressed.deeper(way), 0.5 * before);
      pressed.press(1e-5, 1.01 * after);
      for (const double way : {-1e-4, 1e-4}) EXPECT_LT(pressed.deeper(way), 0.5 * before);
    }
  }
}

TEST(WrenchPrediction, WhatSomethingElseThanItsWayChangesTeachesNothing) {
  WrenchPrediction prediction(kArm);
  PressedOn pressed(prediction);
  const double way = 2e-4, rise = pressed.deeper(way) - pressed.force();
  ASSERT_GT(rise, 0.2 * 193.0 * way);
  prediction.skipNextChange();
  pressed.press(3e-5, 0.4);
  EXPECT_NEAR(pressed.deeper(way) - pressed.force(), rise, 1e-12);
  pressed.press(3e-5, 0.45);  // from here on it learns again
  EXPECT_GT(pressed.deeper(way) - pressed.force(), rise);
}

// At its own pose, from which a force has driven it: the way of the push is no motion.
TEST(WrenchPrediction, OfADrivenToolIsTheSolvedWrenchWhereTheToolStands) {
  const RobotPose stands = at({above(-0.002)});
  Pipeline pipeline(block(), exact(), {withFriction(0.0, probe())});
  pipeline.step(stands);
  WrenchPrediction prediction(kArm);
  for (int force = 10; force <= 20; ++force) {
    pipeline.push(0, Vec3(0.0, 0.0, -0.01 * force));
    for (int update = 0; update < 60 && (update == 0 || pipeline.report().changed); ++update) {
      pipeline.step(stands);
      prediction.learnFrom(pipeline.pose()->links.front(), pipeline.report().tools.front());
    }
  }
  const Vec3 force = wrenchOf(pipeline).force;
  ASSERT_GT(force.z(), 0.15);
  ASSERT_LT(pipeline.report().tools.front().offset.z(), -0.003);
  EXPECT_LT((prediction.at(stands.links.front()).force - force).norm(), 1e-9);
}

TEST(WrenchPrediction, IsToldWithMaxForceAtMostAndKnowsTheStiffnessBeyondIt) {
  constexpr double kMost = 0.1;  // N
  ToolGeometry limited = withFriction(0.0, probe());
  limited.max_force = kMost;
  Pipeline pipeline(block(), exact(), {limited});
  Pipeline free(block(), exact(), {withFriction(0.0, probe())});
  WrenchPrediction prediction(kArm, kMost), of_free(kArm);
  const auto press = [&](double depth) {
    for (Pipeline* each : {&pipeline, &free}) each->step(pressed(depth));
    prediction.learnFrom(poseAt(above(depth)), pipeline.report().tools.front());
    of_free.learnFrom(poseAt(above(depth)), free.report().tools.front());
  };
  for (double depth = -0.001; depth < 0.006; depth += 2.5e-4) press(depth);
  ASSERT_TRUE(pipeline.report().tools.front().saturated);
  const Pose deeper = poseAt(above(0.0065));
  EXPECT_GT(of_free.at(deeper).force.norm(), 2.0 * kMost);
  EXPECT_NEAR(prediction.at(deeper).force.norm(), kMost, 1e-9);
  double depth = 0.006;
  while (pipeline.report().tools.front().saturated && depth > 0.0) press(depth -= 2.5e-4);
  const Pose outwards = poseAt(above(depth - 5e-4));
  const Vec3 force = of_free.at(outwards).force;
  ASSERT_GT(force.z(), 0.0);
  ASSERT_LT(force.norm(), kMost);
  EXPECT_LT((prediction.at(outwards).force - force).norm(), 1e-6 * kMost);
}

TEST(WrenchPrediction, FarOffItStaysWhereItStillCounts) {
  WrenchPrediction prediction(kArm);
  prediction.learn(poseAt(Vec3::Zero()), {Vec3(0.0, 0.0, 1.0), Vec3::Zero()});
  prediction.learn(poseAt(Vec3(0.0, 0.0, -1e-3)), {Vec3(0.0, 0.0, 1.1), Vec3::Zero()});
  const double far = prediction.at(poseAt(Vec3(0.0, 0.0, -0.1))).force.z();
  EXPECT_NEAR(far, prediction.at(poseAt(Vec3(0.0, 0.0, -0.2))).force.z(), 1e-9);
  EXPECT_LT(far, 1.5);
}

TEST(WrenchPrediction, ForetellsNoPoseFarOffAndNoneLongAfter) {
  WrenchPrediction prediction(kArm);
  const Pose solved = poseAt(Vec3(0.1, 0.0, 0.0));
  prediction.learn(solved, {});  // also where nothing touches yet
  EXPECT_TRUE(prediction.foretells(solved, 0.0));
  EXPECT_TRUE(prediction.foretells(poseAt(Vec3(0.1, 0.0, 9e-4)), 0.1));
  EXPECT_FALSE(prediction.foretells(poseAt(Vec3(0.1, 0.0, 2e-3)), 0.0));
  EXPECT_FALSE(prediction.foretells(solved, 1.0));
  Pose turned = solved;
  turned.rotate(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  EXPECT_FALSE(prediction.foretells(turned, 0.0));
}

}  // namespace
}  // namespace robot_tissue::test_wrench_prediction
