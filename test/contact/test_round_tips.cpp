// Meshes that are round as balls are, and those that are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_round_tips {
namespace {

constexpr double kRadius = 0.003;  // m
constexpr double kPadding = 1e-4;  // m

std::vector<Ball> ballsOf(const std::vector<Triangle>& triangles, double padding = 0.0) {
  return ContactFinder({makeTool({mesh(writeStl("tip.stl", triangles))}, padding)}).balls(0);
}

using Outline = std::vector<Eigen::Vector2d>;

// A rod along z, from its tip at 0 on, with a flat upper end.
std::vector<Triangle> rod(Outline tip, double length, int segments) {
  tip.emplace_back(tip.back().x(), length);
  tip.emplace_back(0.0, length);
  return revolvedTriangles(tip, segments);
}

void expectBall(const Ball& ball, const Vec3& center, double radius) {
  EXPECT_LT((ball.center - center).norm(), 1e-3 * radius) << ball.center.transpose();
  EXPECT_NEAR(ball.radius, radius, 1e-3 * radius);
}

TEST(RoundTips, ABallIsOneHoweverFine) {
  for (const int rings : {6, 12, 24}) {
    const std::vector<Ball> balls = ballsOf(ballTriangles(rings, kRadius), kPadding);
    ASSERT_EQ(balls.size(), 1u) << rings;
    expectBall(balls.front(), Vec3::Zero(), kRadius + kPadding);
  }
}

TEST(RoundTips, RodsAreRoundAtTheirRoundEnd) {
  for (const int segments : {12, 16, 40}) {
    const Outline end = roundEnd(kRadius, kRadius, segments / 4);
    const std::vector<Ball> balls = ballsOf(rod(end, 0.02, segments));
    ASSERT_EQ(balls.size(), 1u) << segments;
    expectBall(balls.front(), Vec3(0.0, 0.0, kRadius), kRadius);
  }
  Outline both = roundEnd(kRadius, kRadius, 6);
  for (int i = 6; i >= 0; --i) both.emplace_back(both[at(i)].x(), 0.02 - both[at(i)].y());
  const std::vector<Ball> balls = ballsOf(revolvedTriangles(both, 24));
  ASSERT_EQ(balls.size(), 2u);
  const double sum = balls[0].center.z() + balls[1].center.z();
  EXPECT_NEAR(sum, 0.02, 1e-5);
}

// Vertices of a box, and of a plain cylinder, lie on a ball, but not what is between them.
TEST(RoundTips, BoxesCylindersConesAndEggsAreNotRound) {
  EXPECT_TRUE(ballsOf(boxTriangles(Vec3(0.01, 0.01, 0.01))).empty());
  EXPECT_TRUE(ballsOf(boxTriangles(Vec3(0.01, 0.02, 0.001))).empty());
  for (const int segments : {8, 24}) {
    EXPECT_TRUE(ballsOf(rod({{0.0, 0.0}, {kRadius, 0.0}}, 0.006, segments)).empty());
    EXPECT_TRUE(ballsOf(rod({{0.0, 0.0}, {kRadius, 0.004}}, 0.02, segments)).empty());
  }
  Outline egg = roundEnd(kRadius, kRadius, 16);
  for (int i = 15; i >= 0; --i) egg.emplace_back(egg[at(i)].x(), 2.0 * kRadius - egg[at(i)].y());
  for (Eigen::Vector2d& point : egg) point.y() *= 3.0;
  for (const Ball& ball : ballsOf(revolvedTriangles(egg, 32))) {
    EXPECT_LT(ball.radius, 0.5 * kRadius) << "as its ends are, a third of a radius";
  }
}

// A shaft's end in the ball on it is no flat face.
TEST(RoundTips, AShaftsEndInItsBallHasNoEdges) {
  const Pose up = makePose(Vec3(0.0, 0.0, 0.01));
  for (const double shaft : {kRadius, 0.5 * kRadius}) {
    const ContactFinder finder(
        {makeTool({sphere(kRadius), placedAt(up, cylinder(shaft, 0.02))}, kPadding)});
    for (const double off : {0.0, 0.5 * kRadius, kRadius, 1.1 * kRadius}) {
      EXPECT_FALSE(finder.flatFace(0, Pose::Identity(), -Vec3::UnitZ(), Vec3(off, 0.0, 0.0), 0.01));
      EXPECT_TRUE(finder.flatFace(0, Pose::Identity(), Vec3::UnitZ(), Vec3(off, 0.0, 0.02), 0.01));
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_round_tips
