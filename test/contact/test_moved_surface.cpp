// A finder that has followed a surface through many shapes says what one says that knows only the
// last of them: its trees are moved, not made anew, and nothing of an earlier shape stays.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_moved_surface {
namespace {

const Eigen::Vector3i kCells(8, 8, 6);
constexpr double kSpacing = 0.005;  // m: a block of 40 x 40 x 30 mm with its top at z = 0
constexpr int kSteps = 60;

// A bump and a twist of the block that wander.
class Walk {
 public:
  explicit Walk(const Sheet& block) : block_(block) {}

  std::vector<Vec3> next() {
    for (double& entry : shape_) entry = 0.9 * entry + 0.4 * random(1.0);
    std::vector<Vec3> vertices = block_.vertices;
    for (Vec3& vertex : vertices) {
      const Vec3 from = vertex - Vec3(0.02 + 0.004 * shape_[0], 0.02 + 0.004 * shape_[1], 0.0);
      vertex.z() += 0.006 * shape_[2] * std::exp(-from.squaredNorm() / (0.01 * 0.01));
      vertex.x() += 0.1 * shape_[3] * vertex.z();
      vertex.y() += 0.1 * shape_[4] * vertex.z();
    }
    return vertices;
  }
  Pose place() {
    const Vec3 where(0.02 + random(0.01), 0.02 + random(0.01), random(0.006));
    Pose pose = makePose(where);
    pose.linear() = Eigen::AngleAxisd(random(3.0), Vec3(1.0, random(1.0), random(1.0)).normalized())
                        .toRotationMatrix();
    return pose;
  }

 private:
  double random(double size) {
    return std::uniform_real_distribution<double>(-size, size)(engine_);
  }

  const Sheet& block_;
  std::mt19937 engine_{7};
  std::array<double, 5> shape_{};
};

TEST(MovedSurface, IsSeenAsIfItWereNew) {
  const Sheet block = makeBlock(kCells, kSpacing);
  const ToolGeometry tool = makeTool({sphere(0.006), box(Vec3(0.004, 0.02, 0.006))}, 0.0);
  const ContactFinder old_finder({tool});
  Walk walk(block);
  int met = 0;
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Vec3> vertices = walk.next();
    const Pose pose = walk.place();
    TissueSurface fresh = block.surface;  // its tree is made from this shape
    fresh.rest = vertices;
    const ContactFinder new_finder({tool});
    const double depth = old_finder.penetrations({0}, at(pose), block.surface, vertices)[0];
    EXPECT_NEAR(depth, new_finder.penetrations({0}, at(pose), fresh, vertices)[0], 1e-12);
    const auto of_old = old_finder.find(at(pose), block.surface, vertices, 0.001).contacts;
    const auto of_new = new_finder.find(at(pose), fresh, vertices, 0.001).contacts;
    ASSERT_EQ(of_old.size(), of_new.size());
    for (std::size_t i = 0; i < of_old.size(); ++i) {
      EXPECT_EQ(of_old[i].place.triangle, of_new[i].place.triangle);
      EXPECT_EQ(of_old[i].depth_m, of_new[i].depth_m);
    }
    // Once more, with what find() has met.
    EXPECT_EQ(old_finder.penetrations({0}, at(pose), block.surface, vertices)[0], depth);
    if (depth > 1e-4) ++met;
  }
  EXPECT_GT(met, kSteps / 4);
  EXPECT_LT(met, kSteps);
}

// Where the tool has gone a little, vertices touch it as a new search would find them, and other
// places are as deep as they are there; where it went farther, all is searched anew.
TEST(MovedSurface, PlacesOfTheLastSearchAreSeenFromWhereTheToolIs) {
  constexpr double kMargin = 0.00125, kWay = 0.0002;
  const Sheet block = makeBlock(kCells, kSpacing);
  const ContactFinder finder(
      {makeTool({mesh(writeStl("again.stl", ballTriangles(12, 0.008)))}, 0.0)});
  Walk walk(block);
  const auto depthAtVertices = [&](const ContactSet& found) {
    std::map<int, double> depths;
    for (const Contact& contact : found.contacts) {
      const int vertex = vertexAt(block.surface, contact.place);
      if (vertex >= 0 && contact.depth_m > kWay - kMargin) depths[vertex] = contact.depth_m;
    }
    return depths;
  };
  int met = 0;
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Vec3> vertices = walk.next();
    RobotPose pose = at(walk.place());
    finder.find(pose, block.surface, vertices, kMargin);
    pose.links[0].translation() += 0.6 * kWay * Vec3(0.5, -0.3, 0.7);
    const ContactSet again = finder.findAgain(pose, block.surface, vertices, kMargin, kWay);
    for (const Contact& contact : again.contacts) {
      const auto out = finder.wayOut(0, pose.links[0], contact.point, kMargin);
      ASSERT_TRUE(out);
      EXPECT_EQ(out->depth_m, contact.depth_m);
    }
    const ContactSet anew = finder.find(pose, block.surface, vertices, kMargin);
    EXPECT_EQ(depthAtVertices(again), depthAtVertices(anew));
    met += static_cast<int>(again.contacts.size());
    pose.links[0].translation().x() += 1.1 * kWay;
    const ContactSet far = finder.findAgain(pose, block.surface, vertices, kMargin, kWay);
    const ContactSet new_far = finder.find(pose, block.surface, vertices, kMargin);
    ASSERT_EQ(far.contacts.size(), new_far.contacts.size());
    for (std::size_t i = 0; i < far.contacts.size(); ++i) {
      EXPECT_EQ(far.contacts[i].point, new_far.contacts[i].point);
      EXPECT_EQ(far.contacts[i].depth_m, new_far.contacts[i].depth_m);
    }
  }
  EXPECT_GT(met, 200);
}

// Of its triangle, or near it (m): what is on an edge may be told of the other triangle, and a
// corner stands for what it is as far from as it is deep.
double deepestAround(const Contact& place, const ContactSet& found) {
  double deepest = -kInfinity;
  for (const Contact& contact : found.contacts) {
    const double near = std::max(0.001, contact.depth_m);
    const bool is_near = (contact.point - place.point).norm() < near;
    if (!is_near && contact.place.triangle != place.place.triangle) continue;
    deepest = std::max(deepest, contact.depth_m);
  }
  return deepest;
}

// As the surface and the mesh move, the deepest places are followed: as deep as a new search finds
// them, but for twice its accuracy, and none is missed that touches.
TEST(MovedSurface, FollowedPlacesAreAsDeepAsOfANewSearch) {
  constexpr double kMargin = 0.00125, kAccuracy = 0.005 * 0.0071;  // m: of the longest edge
  const Sheet block = makeBlock(kCells, kSpacing);
  const ToolGeometry tool =
      makeTool({mesh(writeStl("followed.stl", ballTriangles(12, 0.008)))}, 0.0);
  ContactFinder finder({tool});
  finder.followPlaces();
  Walk walk(block);
  int met = 0;
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Vec3> vertices = walk.next();
    const RobotPose pose = at(walk.place());
    finder.find(pose, block.surface, vertices, kMargin);
    std::vector<Vec3> little = vertices;
    double angle = 0.0;
    for (Vec3& vertex : little) {
      vertex += 0.0001 * Vec3(std::sin(7.0 * angle), std::cos(5.0 * angle), std::sin(3.0 * angle));
      angle += 1.0;
    }
    for (const std::vector<Vec3>& moved : {little, walk.next()}) {
      const ContactFinder fresh({tool});
      const ContactSet followed = finder.find(pose, block.surface, moved, kMargin);
      for (const Contact& expected : fresh.find(pose, block.surface, moved, kMargin).contacts) {
        if (expected.depth_m < 0.0) continue;
        EXPECT_GE(deepestAround(expected, followed), expected.depth_m - 2.0 * kAccuracy);
        ++met;
      }
    }
  }
  EXPECT_GT(met, 200);
}

// As around a trial step: places of a search are known again as if nothing had been asked since.
TEST(MovedSurface, WhatIsRestoredIsKnownAgain) {
  constexpr double kMargin = 0.00125, kWay = 0.0002;
  const Sheet block = makeBlock(kCells, kSpacing);
  const ToolGeometry tool =
      makeTool({mesh(writeStl("restored.stl", ballTriangles(12, 0.008)))}, 0.0);
  const ContactFinder finder({tool}), undisturbed({tool});
  Walk walk(block);
  int apart = 0;
  for (int step = 0; step < 20; ++step) {
    const std::vector<Vec3> vertices = walk.next();
    RobotPose pose = at(walk.place());
    finder.find(pose, block.surface, vertices, kMargin);
    undisturbed.find(pose, block.surface, vertices, kMargin);
    const auto kept = finder.kept();
    finder.find(at(walk.place()), block.surface, walk.next(), kMargin);
    finder.restore(*kept, block.surface, vertices);
    pose.links[0].translation() += 0.6 * kWay * Vec3(0.5, -0.3, 0.7);
    const auto again = finder.findAgain(pose, block.surface, vertices, kMargin, kWay).contacts;
    const auto expected =
        undisturbed.findAgain(pose, block.surface, vertices, kMargin, kWay).contacts;
    const auto anew = ContactFinder({tool}).find(pose, block.surface, vertices, kMargin).contacts;
    ASSERT_EQ(again.size(), expected.size());
    for (std::size_t i = 0; i < again.size(); ++i) {
      EXPECT_EQ(again[i].point, expected[i].point);
      apart += i >= anew.size() || again[i].point != anew[i].point ? 1 : 0;
    }
  }
  EXPECT_GT(apart, 20);
}

// What was asked for before, at the same point, place or reach or at others, leaves no trace.
TEST(MovedSurface, WaysOutAreThoseOfAFinderThatIsAskedForTheFirstTime) {
  constexpr double kReach = 0.002;
  const Sheet block = makeBlock(kCells, kSpacing);
  const ToolGeometry tool =
      makeTool({mesh(writeStl("ways.stl", ballTriangles(12, 0.008))), sphere(0.01)}, 0.0);
  ContactFinder finder({tool});
  Walk walk(block);
  int found = 0;
  for (int step = 0; step < 12; ++step) {
    const Pose pose = walk.place();
    const std::size_t shapes = step % 3 == 0 ? 1 : 2;
    finder.useShapes(0, shapes);
    for (std::size_t i = 0; i < block.vertices.size(); i += 5) {
      const Vec3& vertex = block.vertices[i];
      if ((vertex - pose.translation()).norm() > 0.014) continue;
      for (const double reach : {kReach, kReach, 2.0 * kReach}) {
        ContactFinder fresh({tool});
        fresh.useShapes(0, shapes);
        const auto out = finder.wayOut(0, pose, vertex, reach);
        const auto expected = fresh.wayOut(0, pose, vertex, reach);
        ASSERT_EQ(out.has_value(), expected.has_value());
        if (!out) continue;
        EXPECT_EQ(out->depth_m, expected->depth_m);
        EXPECT_EQ(out->normal, expected->normal);
        ++found;
      }
    }
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace robot_tissue::test_moved_surface
