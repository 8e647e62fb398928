// Penetration depth and gaps: known overlaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_penetration {
namespace {

const Eigen::Vector3i kCells(8, 8, 6);
constexpr double kSpacing = 0.005;  // m: a block of 40 x 40 x 30 mm with its top at z = 0
const Vec3 kMiddle(0.021, 0.019, 0.0);

double penetrationOf(const ToolShape& shape, const Pose& pose, double padding = 0.0) {
  const Sheet block = makeBlock(kCells, kSpacing);
  const ContactFinder finder({makeTool({shape}, padding)});
  return finder.penetrations({0}, at(pose), block.surface, block.vertices)[0];
}

TEST(Penetration, SphereOverAFlatTop) {
  for (const double depth : {0.00001, 0.001, 0.004}) {
    const Pose pose = makePose(kMiddle + Vec3(0, 0, 0.005 - depth));
    EXPECT_NEAR(penetrationOf(sphere(0.005), pose), depth, 1e-9);
    EXPECT_NEAR(penetrationOf(sphere(0.004), pose, 0.001), depth, 1e-9);
  }
  EXPECT_EQ(penetrationOf(sphere(0.005), makePose(kMiddle + Vec3(0, 0, 0.00501))), 0.0);
}

// Of the surface in the tool no more than its radius; of the tool in the tissue all of it.
TEST(Penetration, NeedleThroughAFaceCountsItsTip) {
  const Pose upright = makePose(kMiddle + Vec3(0, 0, 0.02 - 0.008));
  EXPECT_NEAR(penetrationOf(cylinder(0.0005, 0.04), upright), 0.008, 1e-9);
  const double angle = 0.5;
  const Pose slanted =
      makePose(kMiddle, angle, Vec3(1, 0.37, 0)) * makePose(Vec3(0, 0, 0.02 - 0.008));
  const double expected = 0.008 * std::cos(angle) + 0.0005 * std::sin(angle);
  EXPECT_NEAR(penetrationOf(cylinder(0.0005, 0.04), slanted), expected, 1e-9);
}

TEST(Penetration, CornerAndFaceOfABox) {
  const ToolShape cube = box(Vec3::Constant(0.01));
  EXPECT_NEAR(penetrationOf(cube, makePose(kMiddle + Vec3(0, 0, 0.005 - 0.002))), 0.002, 1e-9);
  Pose on_corner = makePose(kMiddle + Vec3(0, 0, std::sqrt(0.75) * 0.01 - 0.002));
  on_corner.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1).normalized(), Vec3::UnitZ())
                           .toRotationMatrix();
  EXPECT_NEAR(penetrationOf(cube, on_corner), 0.002, 1e-9);
}

// Points of a top that is drawn below the box are out of it, also those beside one of its sides,
// to which the way is shorter from the triangles.
TEST(Penetration, CountsWhereTheSurfaceIsDrawn) {
  const Sheet block = makeBlock(kCells, kSpacing);
  const ContactFinder finder({makeTool({box(Vec3::Constant(0.01))})});
  const Pose pose = makePose(Vec3(0.0202, 0.019, 0.005 - 0.0006));  // a side at x = 25.2 mm
  const auto depthBelow = [&](double bulge) {
    const auto of_all = [&](std::size_t, const SurfacePoint&) -> Vec3 {
      return -bulge * Vec3::UnitZ();
    };
    return finder.penetrations({0}, at(pose), block.surface, block.vertices, of_all)[0];
  };
  EXPECT_NEAR(depthBelow(0.0), 0.0006, 1e-9);
  EXPECT_NEAR(depthBelow(0.0004), 0.0002, 1e-9);
  EXPECT_EQ(depthBelow(0.0007), 0.0);
}

TEST(Penetration, ToolWhollyBeneathTheSurfaceCounts) {
  const Pose pose = makePose(Vec3(0.02, 0.02, -0.015));
  EXPECT_NEAR(penetrationOf(sphere(0.002), pose), 0.015 + 0.0, 0.002);
  EXPECT_GE(penetrationOf(sphere(0.002), pose), 0.0145);
  const std::string ball = writeStl("beneath.stl", ballTriangles(8, 0.002));
  EXPECT_GE(penetrationOf(mesh(ball), pose), 0.0145);
}

TEST(Penetration, SurfaceInATool) {
  // A slab larger than the block, 3 mm over its top.
  const Pose pose = makePose(Vec3(0.02, 0.02, 0.05 - 0.003));
  EXPECT_NEAR(penetrationOf(box(Vec3::Constant(0.1)), pose), 0.003, 1e-9);
  EXPECT_NEAR(penetrationOf(plane(), makePose(Vec3(0, 0, -0.003), M_PI, Vec3::UnitX())), 0.003,
              1e-9);
}

TEST(Penetration, MeshCountsItsVerticesAndItsNotchDoesNot) {
  const std::string fork = writeStl("deep_fork.stl", forkTriangles(0.004, 0.03, 0.02, 0.004));
  EXPECT_NEAR(penetrationOf(mesh(fork), makePose(kMiddle - Vec3(0.0, 0.0, 0.001))), 0.001, 1e-8);
  // The block between the prongs, which only their bridge would meet.
  const std::string wide = writeStl("wide_fork.stl", forkTriangles(0.004, 0.05, 0.04, 0.01));
  EXPECT_EQ(penetrationOf(mesh(wide), makePose(Vec3(0.02, 0.02, -0.039))), 0.0);
}

TEST(Penetration, PaddedMesh) {
  const std::string cube = writeStl("padded.stl", boxTriangles(Vec3::Constant(0.01)));
  EXPECT_NEAR(penetrationOf(mesh(cube), makePose(kMiddle + Vec3(0, 0, 0.0055)), 0.001), 0.0005,
              1e-8);
}

// The lips of a cut that is not opened lie in one place: what is beside them is inside.
TEST(Penetration, LipsOfAClosedCutAreNoOutside) {
  Sheet halves = makeBlock(Eigen::Vector3i(4, 8, 6), kSpacing);
  const Sheet other = halves;
  const int offset = static_cast<int>(halves.vertices.size());
  for (const Vec3& vertex : other.vertices) halves.addVertex(vertex + Vec3(0.02, 0.0, 0.0));
  for (const MeshTriangle& t : other.surface.triangles) {
    halves.addTriangle(t[0] + offset, t[1] + offset, t[2] + offset);
  }
  const ContactFinder finder({makeTool({cylinder(0.0005, 0.04)})});
  for (const double x : {0.0165, 0.0235}) {
    const Pose pose = makePose(Vec3(x, 0.019, 0.02 - 0.0025));
    EXPECT_NEAR(finder.penetrations({0}, at(pose), halves.surface, halves.vertices)[0], 0.0025,
                1e-9);
  }
}

TEST(Penetration, TellsOfEachLinkThatIsAskedForInTheirOrder) {
  const Sheet block = makeBlock(kCells, kSpacing);
  const ContactFinder finder(
      {makeTool({sphere(0.005)}), makeTool({sphere(0.004)}), makeTool({sphere(0.003)})});
  RobotPose pose;
  pose.links = {makePose(kMiddle + Vec3(0, 0, 0.003)), makePose(Vec3(1.0, 1.0, 1.0)),
                makePose(kMiddle + Vec3(0, 0, 0.002))};
  const std::vector<double> depths =
      finder.penetrations({2, 1, 0}, pose, block.surface, block.vertices);
  ASSERT_EQ(depths.size(), 3U);
  EXPECT_NEAR(depths[0], 0.001, 1e-9);
  EXPECT_EQ(depths[1], 0.0);
  EXPECT_NEAR(depths[2], 0.002, 1e-9);
  EXPECT_TRUE(finder.penetrations({}, pose, block.surface, block.vertices).empty());
  pose.links.pop_back();
  EXPECT_THROW(finder.penetrations({0}, pose, block.surface, block.vertices), InputError);
}

TEST(Penetration, IsOfTheSurfaceAsItIsNow) {
  Sheet block = makeBlock(kCells, kSpacing);
  const ContactFinder finder({makeTool({cylinder(0.0005, 0.04)})});
  const auto ask = [&] {
    const RobotPose pose = at(makePose(Vec3(0.021, 0.019, 0.0185)));
    return finder.penetrations({0}, pose, block.surface, block.vertices)[0];
  };
  EXPECT_NEAR(ask(), 0.0015, 1e-9);
  for (Vec3& vertex : block.vertices) vertex.z() -= 0.001;
  EXPECT_NEAR(ask(), 0.0005, 1e-9);
  block.surface = makeBlock(Eigen::Vector3i(4, 4, 2), 0.01).surface;
  block.vertices = block.surface.rest;
  EXPECT_NEAR(ask(), 0.0015, 1e-9);
  // A vertex at the bottom that is lost takes only its own triangles with it.
  const auto lowest = std::min_element(block.vertices.begin(), block.vertices.end(),
                                       [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  lowest->x() = std::nan("");
  EXPECT_NEAR(ask(), 0.0015, 1e-9);
}

// What a finder keeps of its last looks changes nothing of the next one: the prongs of a fork go
// over bumps, the one and the other in turns.
TEST(Penetration, OfAMeshOnItsWayIsThatOfOneThatComesAnew) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bump(-1e-3, 1e-3), hop(0.0, 2e-3);
  Sheet block = makeBlock(kCells, kSpacing);
  for (Vec3& vertex : block.vertices) vertex.z() += bump(random);
  const ToolGeometry fork =
      makeTool({mesh(writeStl("way.stl", forkTriangles(0.001, 0.006, 0.01, 0.001)))});
  const ContactFinder kept({fork});
  Vec3 place(0.008, 0.0175, 4e-4);
  int deep = 0;
  for (int step = 0; step < 150; ++step) {
    place.x() += step % 20 == 19 ? hop(random) : 1e-4;
    for (Vec3& vertex : block.vertices) vertex.z() += 0.01 * bump(random);
    const RobotPose pose = at(makePose(place));
    const ContactFinder anew({fork});
    const double depth = kept.penetrations({0}, pose, block.surface, block.vertices)[0];
    EXPECT_EQ(depth, anew.penetrations({0}, pose, block.surface, block.vertices)[0]);
    if (depth > 0.0) ++deep;
  }
  EXPECT_GT(deep, 30);
  EXPECT_LT(deep, 150);
}

TEST(Penetration, BadPoseAndApartIsNone) {
  Pose bad = Pose::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_EQ(penetrationOf(sphere(0.01), bad), 0.0);
  EXPECT_EQ(penetrationOf(sphere(0.01), makePose(Vec3(0.0, 0.0, 0.5))), 0.0);
}

double gapOf(const ToolShape& a, const Pose& at_a, const ToolShape& b, const Pose& at_b,
             double padding = 0.0) {
  const ContactFinder finder({makeTool({a}, padding), makeTool({b}, padding)});
  RobotPose pose;
  pose.links = {at_a, at_b};
  const double gap = finder.gap(0, 1, pose);
  EXPECT_NEAR(finder.gap(1, 0, pose), gap, 1e-6);
  return gap;
}

TEST(Gap, BetweenShapesSideBySide) {
  const Vec3 size(0.01, 0.02, 0.004);
  const ToolShape as_mesh = mesh(writeStl("jaw.stl", boxTriangles(size)));
  const ToolShape can = cylinder(0.005, 0.02);
  const ToolShape ball = sphere(0.005);
  const ToolShape brick = box(size);
  for (const double gap : {0.0001, 0.002, 0.05}) {
    const Pose apart = makePose(Vec3(0.01 + gap, 0.0, 0.0));
    for (const ToolShape& a : {as_mesh, can, ball, brick}) {
      for (const ToolShape& b : {as_mesh, can, ball, brick}) {
        EXPECT_NEAR(gapOf(a, Pose::Identity(), b, apart), gap, 2e-6);
        EXPECT_NEAR(gapOf(a, Pose::Identity(), b, apart, 0.00002), gap - 0.00004, 2e-6);
      }
    }
  }
}

TEST(Gap, IsZeroForShapesThatOverlap) {
  const Vec3 size(0.01, 0.02, 0.01);
  const ToolShape as_mesh = mesh(writeStl("jaw_over.stl", boxTriangles(size)));
  const ToolShape small = mesh(writeStl("jaw_small.stl", boxTriangles(0.3 * size)));
  for (const ToolShape& a : {as_mesh, cylinder(0.005, 0.02), sphere(0.005), box(size)}) {
    for (const ToolShape& b :
         {as_mesh, cylinder(0.005, 0.02), sphere(0.005), box(size), small, box(0.3 * size)}) {
      EXPECT_EQ(gapOf(a, Pose::Identity(), b, makePose(Vec3(0.001, 0.001, 0.0005))), 0.0);
    }
  }
  EXPECT_EQ(gapOf(box(size), Pose::Identity(), box(size), makePose(Vec3(0.0103, 0, 0)), 0.0002),
            0.0);
}

TEST(Gap, IsToldAsItIsWithinReachAndWiderBeyond) {
  const Vec3 size(0.01, 0.02, 0.004);
  const ToolShape as_mesh = mesh(writeStl("jaw_reach.stl", boxTriangles(size)));
  const ToolShape round = mesh(writeStl("ball_reach.stl", ballTriangles(8, 0.005)));
  const Pose tilted(Eigen::AngleAxisd(0.6, Vec3(1.0, 2.0, 0.5).normalized()));
  for (const ToolShape& a : {as_mesh, round, box(size), cylinder(0.005, 0.02), sphere(0.005)}) {
    for (const ToolShape& b : {as_mesh, round, box(size), cylinder(0.005, 0.02), plane()}) {
      const ContactFinder finder({makeTool({a}, 0.0002), makeTool({b}, 0.0002)});
      for (const double off : {0.001, 0.007, 0.011, 0.03}) {
        RobotPose pose;
        pose.links = {makePose(off * Vec3(0.3, 1.0, 1.0)), tilted};
        const double gap = finder.gap(0, 1, pose);
        EXPECT_EQ(finder.gap(0, 1, pose, gap), gap);
        EXPECT_EQ(finder.gap(0, 1, pose, gap + 0.01), gap);
        if (gap == 0.0) continue;
        for (const double part : {0.0, 0.5, 0.99}) {
          EXPECT_GT(finder.gap(0, 1, pose, part * gap), part * gap);
        }
      }
    }
  }
}

TEST(Gap, OfCornersAndOverAPlane) {
  const ToolShape cube = box(Vec3::Constant(0.01));
  EXPECT_NEAR(gapOf(cube, Pose::Identity(), cube, makePose(Vec3::Constant(0.013))),
              std::sqrt(3.0) * 0.003, 2e-6);
  const std::string ball = writeStl("over_plane.stl", ballTriangles(8, 0.005));
  for (const ToolShape& shape : {sphere(0.005), cylinder(0.003, 0.01), cube, mesh(ball)}) {
    EXPECT_NEAR(gapOf(plane(), Pose::Identity(), shape, makePose(Vec3(0.3, 0.1, 0.007))), 0.002,
                1e-8);
    EXPECT_EQ(gapOf(plane(), Pose::Identity(), shape, makePose(Vec3(0.3, 0.1, 0.004))), 0.0);
  }
}

TEST(Gap, IsTheLeastOfAllShapesAndSeesIntoNotches) {
  const ToolShape fork = mesh(writeStl("gap_fork.stl", forkTriangles(0.004, 0.01, 0.02, 0.006)));
  EXPECT_NEAR(gapOf(fork, Pose::Identity(), cylinder(0.002, 0.01), makePose(Vec3(0.001, 0, 0.01))),
              0.002, 2e-6);
  const ContactFinder finder(
      {makeTool({sphere(0.001), placedAt(makePose(Vec3(0.01, 0, 0)), sphere(0.002))}),
       makeTool({box(Vec3::Constant(0.002))})});
  RobotPose pose;
  pose.links = {Pose::Identity(), makePose(Vec3(0.02, 0, 0))};
  EXPECT_NEAR(finder.gap(0, 1, pose), 0.007, 1e-9);
}

}  // namespace
}  // namespace robot_tissue::test_penetration
