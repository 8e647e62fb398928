// What presses between the vertices of the surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_deepest_point {
namespace {

double deepestOf(const ContactSet& found) {
  double deepest = -1.0;
  for (const Contact& contact : found.contacts) deepest = std::max(deepest, contact.depth_m);
  return deepest;
}

ContactSet findOn(const ContactFinder& finder, const Pose& pose, const Sheet& sheet,
                  double margin = 0.0) {
  return finder.find(at(pose), sheet.surface, sheet.vertices, margin);
}

// A point of a box with its lowest corner, or with an edge along y lowest, at the origin.
Pose onCorner(double half) {
  Pose pose = makePose(Vec3::Zero());
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vec3(-1, -1, -1).normalized(), Vec3(-Vec3::UnitZ()))
          .toRotationMatrix();
  pose.translation() = Vec3(0.0, 0.0, std::sqrt(3.0) * half);
  return pose;
}
Pose onEdge(double half) {
  return makePose(Vec3(0.0, 0.0, std::sqrt(2.0) * half), 0.25 * M_PI, Vec3::UnitY());
}

TEST(DeepestPoint, NeedleBetweenTheNodesIsFoundWhereverItStands) {
  const ContactFinder finder({makeTool({cylinder(0.0005, 0.05)})});
  const double depth = 0.0001;
  for (const double spacing : {0.005, 0.02}) {
    const Sheet sheet = makeSheet(4, spacing);
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) {
        const Vec3 tip =
            spacing * Vec3(1.0 + 0.05 * i, 1.0 + 0.05 * j, 0.0) - depth * Vec3::UnitZ();
        const ContactSet found = findOn(finder, makePose(tip + Vec3(0.0, 0.0, 0.025)), sheet);
        ASSERT_FALSE(found.contacts.empty()) << tip.transpose();
        EXPECT_NEAR(deepestOf(found), depth, 1e-12);
      }
    }
  }
}

TEST(DeepestPoint, SlantedNeedleIsFoundAtItsRim) {
  const double radius = 0.0005, length = 0.05, angle = 0.6, depth = 0.0002;
  const ContactFinder finder({makeTool({cylinder(radius, length)})});
  const Sheet sheet = makeSheet(4, 0.02);
  const double lowest = 0.5 * length * std::cos(angle) + radius * std::sin(angle);
  for (int i = 0; i <= 20; ++i) {
    const Vec3 axis(std::cos(0.3 * i), std::sin(0.3 * i), 0.0);
    Pose pose = makePose(Vec3(0.037 + 0.0007 * i, 0.041, lowest - depth), angle, axis);
    // Where it is as far through the cap as through the side.
    const double expected = depth / (std::sin(angle) + std::cos(angle));
    EXPECT_NEAR(deepestOf(findOn(finder, pose, sheet)), expected, 2e-5) << i;
  }
}

TEST(DeepestPoint, FirstTouchOfARimIsFoundInALargeTriangle) {
  const double radius = 0.005, length = 0.02, depth = 1e-6;
  const ContactFinder finder({makeTool({cylinder(radius, length)})});
  const Sheet sheet = makeTriangle(Vec3(-0.04, -0.03, 0), Vec3(0.05, -0.02, 0), Vec3(0, 0.06, 0));
  for (int i = 1; i < 60; ++i) {
    const double angle = 0.026 * i;
    const double lowest = 0.5 * length * std::cos(angle) + radius * std::sin(angle);
    const Pose pose =
        makePose(Vec3(0.0001 * i, 0.0, lowest - depth), angle, Vec3(std::cos(i), std::sin(i), 0.0));
    EXPECT_FALSE(findOn(finder, pose, sheet).contacts.empty()) << i;
  }
}

TEST(DeepestPoint, SphereIsFoundAtItsFirstTouch) {
  const Sheet sheet = makeSheet(6, 0.005);
  const double depth = 1e-5;
  const ContactFinder finder({makeTool({sphere(0.01)})});
  for (int i = 0; i <= 10; ++i) {
    const Vec3 lowest(0.01 + 0.0005 * i, 0.0125, -depth);
    const ContactSet found = findOn(finder, makePose(lowest + Vec3(0.0, 0.0, 0.01)), sheet);
    ASSERT_FALSE(found.contacts.empty()) << i;
    const auto deepest =
        std::max_element(found.contacts.begin(), found.contacts.end(),
                         [](const Contact& a, const Contact& b) { return a.depth_m < b.depth_m; });
    EXPECT_NEAR(deepest->depth_m, depth, 1e-12);
    EXPECT_NEAR((deepest->point - Vec3(lowest.x(), lowest.y(), 0.0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR((deepest->normal + Vec3::UnitZ()).norm(), 0.0, 1e-6);
  }
}

TEST(DeepestPoint, EdgeOfABoxAcrossATriangleIsFound) {
  const double half = 0.005, depth = 0.0002;
  const ContactFinder finder({makeTool({box(Vec3::Constant(2.0 * half))})});
  const Sheet sheet =
      makeTriangle(Vec3(-0.01, -0.008, 0.0), Vec3(0.012, -0.006, 0.0), Vec3(0.001, 0.015, 0.0));
  const ContactSet found = findOn(finder, makePose(Vec3(0, 0, -depth)) * onEdge(half), sheet);
  ASSERT_EQ(found.contacts.size(), 1U);
  // Half way between the faces: the way out is through one of them.
  EXPECT_NEAR(found.contacts[0].depth_m, depth / std::sqrt(2.0), 0.005 * 0.024);
  EXPECT_NEAR(std::abs(found.contacts[0].normal.z()), std::sqrt(0.5), 1e-9);
  EXPECT_LT(found.contacts[0].normal.z(), 0.0);
}

TEST(DeepestPoint, CornerOfABoxInATriangleIsFound) {
  const double half = 0.005, depth = 0.0003;
  const ContactFinder finder({makeTool({box(Vec3::Constant(2.0 * half))})});
  const Sheet sheet =
      makeTriangle(Vec3(-0.01, -0.008, 0.0), Vec3(0.012, -0.006, 0.0), Vec3(0.001, 0.015, 0.0));
  const ContactSet found = findOn(finder, makePose(Vec3(0, 0, -depth)) * onCorner(half), sheet);
  ASSERT_EQ(found.contacts.size(), 1U);
  EXPECT_NEAR(found.contacts[0].depth_m, depth / std::sqrt(3.0), 1e-5);
  EXPECT_LT(found.contacts[0].point.norm(), 0.0005);
}

TEST(DeepestPoint, RimOfACylinderAcrossATriangleIsFound) {
  const double radius = 0.01, length = 0.02, depth = 0.001;
  const ContactFinder finder({makeTool({cylinder(radius, length)})});
  const double lowest = (0.5 * length + radius) / std::sqrt(2.0);
  const Pose pose = makePose(Vec3(0.0, 0.0, lowest - depth), 0.25 * M_PI, Vec3::UnitX());
  const Vec3 rim = pose * Vec3(0.0, -radius, -0.5 * length);
  const Sheet sheet =
      makeTriangle(rim + Vec3(-0.01, -0.008, depth), rim + Vec3(0.012, -0.006, depth),
                   rim + Vec3(0.001, 0.015, depth));
  ASSERT_NEAR(sheet.vertices[0].z(), 0.0, 1e-12);
  const ContactSet found = findOn(finder, pose, sheet);
  ASSERT_EQ(found.contacts.size(), 1U);
  EXPECT_NEAR(found.contacts[0].depth_m, depth / std::sqrt(2.0), 0.005 * 0.024);
}

TEST(DeepestPoint, FlatFaceOverFlatTrianglesNeedsNoPointsBetweenTheVertices) {
  const Sheet sheet = makeSheet(4, 0.005);
  const ContactFinder finder({makeTool({box(Vec3(0.1, 0.1, 0.1))}), makeTool({plane()})});
  RobotPose pose;
  pose.links = {makePose(Vec3(0.01, 0.01, 0.049)),
                makePose(Vec3(0.0, 0.0, -0.002), M_PI, Vec3::UnitX())};
  const ContactSet found = finder.find(pose, sheet.surface, sheet.vertices, 0.0);
  ASSERT_EQ(found.contacts.size(), 2 * sheet.vertices.size());
  for (const Contact& contact : found.contacts) {
    EXPECT_NEAR(contact.place.barycentric.maxCoeff(), 1.0, 0.0);
    EXPECT_NEAR(contact.depth_m, contact.link == 0 ? 0.001 : 0.002, 1e-12);
    EXPECT_NEAR((contact.normal + Vec3::UnitZ()).norm(), 0.0, 1e-12);
  }
}

TEST(DeepestPoint, PlaneTouchesOnlyWhatIsBelowIt) {
  const Sheet sheet = makeSheet(4, 0.005);
  const ContactFinder finder({makeTool({plane()}, 0.001)});
  const Pose slanted = makePose(Vec3(0.01, 0.0, -0.0), 0.3, Vec3::UnitY());
  const ContactSet found = findOn(finder, slanted, sheet);
  EXPECT_EQ(found.contacts.size(), 15U);  // x of 0, 0.005 and, by the padding, 0.01
  for (const Contact& contact : found.contacts) {
    EXPECT_NEAR(contact.depth_m, 0.001 - std::sin(0.3) * (contact.point.x() - 0.01), 1e-12);
  }
}

TEST(DeepestPoint, MarginTellsGapsToo) {
  const Sheet sheet = makeSheet(4, 0.02);
  for (const ToolShape& shape :
       {sphere(0.003), mesh(writeStl("margin.stl", ballTriangles(8, 0.003)))}) {
    const ContactFinder finder({makeTool({shape})});
    const Pose pose = makePose(Vec3(0.033, 0.029, 0.0035));
    EXPECT_TRUE(findOn(finder, pose, sheet, 0.0004).contacts.empty());
    const ContactSet found = findOn(finder, pose, sheet, 0.0006);
    ASSERT_EQ(found.contacts.size(), 1U);
    EXPECT_NEAR(found.contacts[0].depth_m, -0.0005, 1e-8);
    // A mesh's place is found to some hundredths of a millimeter.
    const double exact = shape.type == ToolShape::Type::kMesh ? 0.01 : 1e-5;
    EXPECT_NEAR((found.contacts[0].normal + Vec3::UnitZ()).norm(), 0.0, exact);
  }
}

// The least of many points of the triangle; those of the corners are told by themselves.
double deepestOfSamples(const ContactFinder& finder, const Pose& pose, const Sheet& sheet) {
  const int n = 120;
  double deepest = -1.0;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n - i; ++j) {
      const Vec3 w = Vec3(i, j, n - i - j) / n;
      const Vec3 point =
          w[0] * sheet.vertices[0] + w[1] * sheet.vertices[1] + w[2] * sheet.vertices[2];
      deepest = std::max(deepest, finder.wayOut(0, pose, point, 1.0)->depth_m);
    }
  }
  return deepest;
}

// Depths as by dense samples, on triangles in and around the shapes.
void expectDeepestOnRandomTriangles(const std::vector<ToolShape>& shapes, int triangles) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double scale) -> Vec3 {
    return scale * Vec3(unit(random), unit(random), unit(random));
  };
  const double margin = 0.001;
  int touching = 0, apart = 0;
  for (int i = 0; i < triangles; ++i) {
    const double padding = i % 2 == 0 ? 0.0008 : 0.0;
    const auto& shape = shapes[static_cast<std::size_t>(i) % shapes.size()];
    const ContactFinder finder({makeTool({shape}, padding)});
    const Pose pose = makePose(vector(0.006), 3.0 * unit(random), vector(1.0));
    const Sheet sheet = makeTriangle(vector(0.01), vector(0.01), vector(0.01));
    const double expected = deepestOfSamples(finder, pose, sheet);
    const ContactSet found = findOn(finder, pose, sheet, margin);
    const double longest = std::max({(sheet.vertices[0] - sheet.vertices[1]).norm(),
                                     (sheet.vertices[1] - sheet.vertices[2]).norm(),
                                     (sheet.vertices[2] - sheet.vertices[0]).norm()});
    const double accuracy = std::max(1e-5, 0.005 * longest);
    if (expected > -margin + 1e-6) {
      ++touching;
      ASSERT_FALSE(found.contacts.empty()) << i;
      EXPECT_GE(deepestOf(found), expected - accuracy) << i;
      // The samples, too, are not nearer to the deepest point than their spacing.
      EXPECT_LE(deepestOf(found), expected + longest / 120.0) << i;
    } else if (expected < -margin - longest / 120.0) {
      ++apart;
      EXPECT_TRUE(found.contacts.empty()) << i;
    }
  }
  EXPECT_GT(touching, triangles / 4);
  EXPECT_GT(apart, triangles / 20);
}

TEST(DeepestPoint, OfConvexShapesAgreesWithDenseSamples) {
  expectDeepestOnRandomTriangles({sphere(0.006), box(Vec3(0.008, 0.004, 0.012)),
                                  cylinder(0.004, 0.01), cylinder(0.0005, 0.03), plane()},
                                 400);
}

TEST(DeepestPoint, OfMeshesAgreesWithDenseSamples) {
  expectDeepestOnRandomTriangles(
      {mesh(writeStl("random_box.stl", boxTriangles(Vec3(0.008, 0.004, 0.012)))),
       mesh(writeStl("random_fork.stl", forkTriangles(0.001, 0.004, 0.01, 0.002))),
       mesh(writeStl("random_ball.stl", ballTriangles(16, 0.006)))},
      300);
}

TEST(DeepestPoint, PointOfAnEdgeIsFoundOnce) {
  Sheet sheet = makeTriangle(Vec3(0.0, -0.01, 0.0), Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.01, 0.0));
  sheet.addVertex(Vec3(-0.01, 0.0, 0.0));
  sheet.addTriangle(0, 2, 3);
  for (const ToolShape& shape : {sphere(0.002), cylinder(0.001, 0.004),
                                 mesh(writeStl("edge.stl", ballTriangles(8, 0.002)))}) {
    const ContactFinder finder({makeTool({shape})});
    const ContactSet found = findOn(finder, makePose(Vec3(0.0, 0.001, 0.0019)), sheet);
    ASSERT_EQ(found.contacts.size(), 1U);
    EXPECT_EQ(found.contacts[0].place.triangle, 0);
    EXPECT_NEAR(found.contacts[0].depth_m, 0.0001, 1e-5);
  }
}

}  // namespace
}  // namespace robot_tissue::test_deepest_point
