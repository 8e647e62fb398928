// Meshes touch as they are: concave parts, notches, tips.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_mesh_tool {
namespace {

ContactSet findOn(const ContactFinder& finder, const Pose& pose, const Sheet& sheet,
                  double margin = 0.0) {
  return finder.find(at(pose), sheet.surface, sheet.vertices, margin);
}

// A pyramid with its tip at the origin, opening upwards.
std::vector<Triangle> spike(double half_width, double height) {
  const Vec3 tip = Vec3::Zero();
  const Vec3 base[] = {Vec3(-half_width, -half_width, height),
                       Vec3(half_width, -half_width, height), Vec3(half_width, half_width, height),
                       Vec3(-half_width, half_width, height)};
  std::vector<Triangle> triangles;
  for (int k = 0; k < 4; ++k) triangles.push_back({{tip, base[(k + 1) % 4], base[k]}});
  triangles.push_back({{base[0], base[1], base[2]}});
  triangles.push_back({{base[0], base[2], base[3]}});
  return triangles;
}

// Distance of a point to the fork of forkTriangles(), as the least over its three bars; right
// outside it.
double forkDistance(double prong, double notch, double height, double width, const Vec3& p) {
  const double x = 0.5 * (notch + prong);
  const Vec3 bar(prong, width, height + prong);
  double least = std::numeric_limits<double>::infinity();
  for (const double side : {-x, x}) {
    least = std::min(least, boxDistance(bar, p - Vec3(side, 0.0, 0.5 * (height + prong))));
  }
  const Vec3 bridge(notch + 2.0 * prong, width, prong);
  return std::min(least, boxDistance(bridge, p - Vec3(0.0, 0.0, height + 0.5 * prong)));
}

TEST(MeshTool, NotchOfAForkIsOutside) {
  for (const double notch : {0.01, 0.0002}) {
    const double prong = 0.004, height = 0.02, width = 0.006, padding = 0.00005;
    const ContactFinder finder({makeTool(
        {mesh(writeStl("fork.stl", forkTriangles(prong, notch, height, width)))}, padding)});
    EXPECT_TRUE(finder.warnings().empty());
    const auto ask = [&](const Vec3& p) { return finder.wayOut(0, Pose::Identity(), p, 1.0); };
    EXPECT_NEAR(ask(Vec3(0.0, 0.0, 0.01))->depth_m, padding - 0.5 * notch, 1e-8);
    EXPECT_NEAR(ask(Vec3(0.25 * notch, 0.0, 0.01))->normal.x(), -1.0, 1e-5);
    EXPECT_NEAR(ask(Vec3(0.5 * notch + 0.001, 0.0, 0.01))->depth_m, padding + 0.001, 1e-8);
    for (const Vec3& point : grid(Vec3(0.02, 0.01, 0.03))) {
      const double expected = forkDistance(prong, notch, height, width, point);
      if (std::abs(expected) < 1e-7) continue;
      EXPECT_EQ(ask(point)->depth_m > padding, expected < 0.0) << point.transpose();
      if (expected > 0.0) {
        EXPECT_NEAR(ask(point)->depth_m, padding - expected, 1e-7);
      }
    }
  }
}

// Nearest points that are edges and corners, where the normals of single triangles tell wrong.
TEST(MeshTool, SignIsRightBesideSharpCorners) {
  const ContactFinder finder({makeTool({mesh(writeStl("spike.stl", spike(0.001, 0.02)))})});
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.1 * i;
    const Vec3 below(0.002 * std::cos(angle), 0.002 * std::sin(angle), -0.001 - 0.00001 * i);
    const auto out = finder.wayOut(0, Pose::Identity(), below, 1.0);
    EXPECT_NEAR(out->depth_m, -below.norm(), 1e-9);
    EXPECT_NEAR((out->normal - below.normalized()).norm(), 0.0, 1e-9);
  }
}

TEST(MeshTool, BothProngsOfAForkTouchOneTriangle) {
  const double depth = 0.0002;
  const ContactFinder finder(
      {makeTool({mesh(writeStl("prongs.stl", forkTriangles(0.001, 0.004, 0.02, 0.001)))})});
  const Sheet sheet = makeTriangle(Vec3(-0.02, -0.01, 0), Vec3(0.02, -0.01, 0), Vec3(0, 0.03, 0));
  const ContactSet found = findOn(finder, makePose(Vec3(0.0003, 0.0, -depth)), sheet);
  int left = 0, right = 0;
  for (const Contact& contact : found.contacts) {
    EXPECT_NEAR(contact.depth_m, depth, 1e-8);
    EXPECT_NEAR((contact.normal + Vec3::UnitZ()).norm(), 0.0, 1e-6);
    EXPECT_NEAR(std::abs(contact.point.x() - 0.0003), 0.0025, 0.00051);
    ++(contact.point.x() < 0.0 ? left : right);
  }
  EXPECT_GT(left, 0);
  EXPECT_GT(right, 0);
}

// A triangle under the prongs ends where they are nearest to it.
TEST(MeshTool, BothProngsAreFoundBesideAnEdgeOfATriangle) {
  const ContactFinder finder(
      {makeTool({mesh(writeStl("beside.stl", forkTriangles(0.001, 0.004, 0.02, 0.001)))})});
  // The prongs point to -x and upwards, and roll a little.
  Eigen::Matrix3d lying;  // of the fork: x to y, y to z, z to x
  lying << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  Pose pose = makePose(Vec3(-0.005, 0.0, 0.0016));
  pose.linear() =
      Eigen::AngleAxisd(0.1, Vec3::UnitY()) * Eigen::AngleAxisd(0.02, Vec3::UnitX()) * lying;
  const Sheet sheet = makeTriangle(Vec3(0.002, -0.02, 0), Vec3(0.002, 0.02, 0), Vec3(-0.03, 0, 0));
  int left = 0, right = 0;
  for (const Contact& contact : findOn(finder, pose, sheet, 0.001).contacts) {
    if (std::abs(contact.point.x() - 0.002) > 1e-6) continue;
    ++(contact.point.y() < 0.0 ? left : right);
  }
  EXPECT_EQ(left, 1);
  EXPECT_EQ(right, 1);
}

TEST(MeshTool, TipBetweenTheVerticesIsFoundWhereverItStands) {
  const ContactFinder finder({makeTool({mesh(writeStl("tip.stl", spike(0.0005, 0.01)))})});
  for (const double spacing : {0.005, 0.02}) {
    const Sheet sheet = makeSheet(4, spacing);
    for (int i = 0; i <= 10; ++i) {
      for (int j = 0; j <= 10; ++j) {
        for (const double slant : {0.0, 0.9}) {
          const Vec3 place = spacing * Vec3(1.05 + 0.083 * i, 1.02 + 0.091 * j, 0.0);
          const Pose pose = makePose(place, slant, Vec3(1, 0.3, 0)) *
                            makePose(Vec3(0.0, 0.0, -0.002));  // along the spike
          EXPECT_FALSE(findOn(finder, pose, sheet).contacts.empty()) << place.transpose();
        }
      }
    }
  }
}

TEST(MeshTool, EdgeOfAMeshAcrossATriangleIsFound) {
  const ContactFinder finder(
      {makeTool({mesh(writeStl("ridge.stl", boxTriangles(Vec3(0.01, 0.05, 0.01))))})});
  const double depth = 0.0004;
  const Pose pose =
      makePose(Vec3(0.0, 0.0, 0.01 / std::sqrt(2.0) - depth), 0.25 * M_PI, Vec3::UnitY());
  const Sheet sheet =
      makeTriangle(Vec3(-0.01, -0.008, 0), Vec3(0.012, -0.006, 0), Vec3(0, 0.015, 0));
  const ContactSet found = findOn(finder, pose, sheet);
  ASSERT_FALSE(found.contacts.empty());
  EXPECT_NEAR(found.contacts[0].depth_m, depth / std::sqrt(2.0), 0.005 * 0.024);
}

TEST(MeshTool, RoundMeshAgreesWithTheSphere) {
  const double radius = 0.01;
  const int rings = 24;
  const ContactFinder round({makeTool({mesh(writeStl("ball.stl", ballTriangles(rings, radius)))})});
  const double sag = radius * (1.0 - std::cos(M_PI / rings));  // greatest, of face under sphere
  for (const Vec3& point : grid(Vec3::Constant(0.0143))) {
    const double depth = radius - point.norm();
    const auto out = round.wayOut(0, Pose::Identity(), point, 1.0);
    EXPECT_LE(out->depth_m, depth + 1e-8);
    EXPECT_GE(out->depth_m, depth - sag - 1e-8);
  }
}

// The middle of a fork is in its notch, that of two balls between them.
TEST(MeshTool, InnerPointsAreDeepInsideEachPart) {
  const double prong = 0.004, radius = 0.006;
  std::vector<Triangle> balls = ballTriangles(12, radius);
  for (Triangle triangle : ballTriangles(12, radius)) {
    for (Vec3& corner : triangle) corner.x() += 0.05;
    balls.push_back(triangle);
  }
  const Pose lifted = makePose(Vec3(0.0, 0.0, 0.1));
  const std::string fork = writeStl("inner_fork.stl", forkTriangles(prong, 0.01, 0.02, 0.006));
  const ContactFinder finder({makeTool({placedAt(lifted, mesh(fork))}),
                              makeTool({mesh(writeStl("inner_balls.stl", balls))}),
                              makeTool({box(Vec3::Constant(0.01)), sphere(0.01), plane()})});
  const auto depth = [&](std::size_t link, const Vec3& point) {
    return finder.wayOut(link, Pose::Identity(), point, 1.0)->depth_m;
  };
  ASSERT_EQ(finder.innerPoints(0).size(), 1U);
  EXPECT_NEAR(depth(0, finder.innerPoints(0)[0]), 0.5 * prong, 0.15 * prong);
  ASSERT_EQ(finder.innerPoints(1).size(), 2U);
  for (const Vec3& point : finder.innerPoints(1)) EXPECT_GT(depth(1, point), 0.9 * radius);
  EXPECT_GT((finder.innerPoints(1)[1] - finder.innerPoints(1)[0]).norm(), 0.04);
  EXPECT_EQ(finder.innerPoints(2).size(), 2U) << "none of the plane";
}

TEST(ContactFinder, TellsInsideTheSurfaceFromOutside) {
  const Sheet block = makeBlock({4, 4, 4}, 0.01);
  const ContactFinder finder({makeTool({sphere(0.01)})});
  const auto is_inside = [&](const Vec3& point) {
    return finder.isInside(point, block.surface, block.vertices);
  };
  EXPECT_TRUE(is_inside(Vec3(0.02, 0.02, -0.02)));
  EXPECT_TRUE(is_inside(Vec3(0.02, 0.02, -1e-6)));
  EXPECT_FALSE(is_inside(Vec3(0.02, 0.02, 1e-6)));
  EXPECT_FALSE(is_inside(Vec3(0.02, 0.05, -0.02)));
}

TEST(MeshTool, MeshThatCrossesItselfWorksAndIsWarnedOf) {
  std::vector<Triangle> cross = boxTriangles(Vec3(0.03, 0.01, 0.01));
  for (const Triangle& t : boxTriangles(Vec3(0.008, 0.04, 0.008))) cross.push_back(t);
  const ContactFinder finder({makeTool({mesh(writeStl("cross.stl", cross))})});
  ASSERT_EQ(finder.warnings().size(), 1U);
  for (const char* word : {"'probe'", "'tip'", "shape 1", "cross.stl", "intersects itself"}) {
    EXPECT_NE(finder.warnings()[0].find(word), std::string::npos) << finder.warnings()[0];
  }
  for (const Vec3& point : grid(Vec3(0.02, 0.025, 0.007))) {
    const double one = boxDistance(Vec3(0.03, 0.01, 0.01), point);
    const double two = boxDistance(Vec3(0.008, 0.04, 0.008), point);
    if (std::abs(std::min(one, two)) < 1e-7) continue;
    EXPECT_EQ(finder.wayOut(0, Pose::Identity(), point, 1.0)->depth_m > 0.0,
              std::min(one, two) < 0.0);
  }
}

}  // namespace
}  // namespace robot_tissue::test_mesh_tool
