// Flat faces of links: where their edges are from a point.
#include <gtest/gtest.h>

#include <cmath>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_flat_face {
namespace {

constexpr double kReach = 0.05;
const Vec3 kDown = -Vec3::UnitZ();

std::optional<FlatFace> faceBelow(const ContactFinder& finder, const Vec3& point,
                                  const Vec3& facing = kDown) {
  return finder.flatFace(0, Pose::Identity(), facing, point, kReach);
}

double depthAlong(const FlatFace& face, const Vec3& outward) {
  for (const FaceEdge& edge : face.edges) {
    if (edge.outward.dot(outward) > 1.0 - 1e-6) return edge.depth_m;
  }
  return std::nan("");
}

TEST(FlatFace, EdgesOfABoxAndOfItsMeshAreTheSame) {
  const Vec3 size(0.02, 0.03, 0.01);
  for (const bool is_mesh : {false, true}) {
    const ContactFinder finder(
        {makeTool({is_mesh ? mesh(writeStl("plate.stl", boxTriangles(size))) : box(size)})});
    ASSERT_TRUE(finder.hasFlatFaces(0));
    const auto face = faceBelow(finder, Vec3(0.007, 0.001, -0.006));
    ASSERT_TRUE(face) << is_mesh;
    EXPECT_NEAR((face->normal - kDown).norm(), 0.0, 1e-6);
    EXPECT_NEAR(face->height_m, 0.001, 1e-8);
    ASSERT_EQ(face->edges.size(), 4u) << is_mesh;
    EXPECT_NEAR(face->edges.front().depth_m, 0.003, 1e-8);
    EXPECT_NEAR(depthAlong(*face, Vec3::UnitX()), 0.003, 1e-8);
    EXPECT_NEAR(depthAlong(*face, -Vec3::UnitX()), 0.017, 1e-8);
    EXPECT_NEAR(depthAlong(*face, Vec3::UnitY()), 0.014, 1e-8);
    EXPECT_NEAR(depthAlong(*face, -Vec3::UnitY()), 0.016, 1e-8);
    EXPECT_NEAR(depthAlong(*faceBelow(finder, Vec3(0.012, 0.0, -0.005)), Vec3::UnitX()), -0.002,
                1e-8);
    const Vec3 aslant = (kDown + Vec3::UnitX()).normalized();  // by 45 degrees
    EXPECT_FALSE(faceBelow(finder, Vec3(0.007, 0.001, -0.006), aslant));
  }
}

TEST(FlatFace, EndOfACylinder) {
  const ContactFinder finder({makeTool({cylinder(0.01, 0.04)}, 0.001)});
  const Vec3 toward = Vec3(3.0, 4.0, 0.0) / 5.0;
  const auto face = faceBelow(finder, 0.008 * toward - 0.022 * Vec3::UnitZ());
  ASSERT_TRUE(face);
  EXPECT_NEAR(face->height_m, 0.001, 1e-12);
  EXPECT_NEAR(face->roundness_m, 0.001, 1e-12);
  EXPECT_NEAR(depthAlong(*face, toward), 0.002, 1e-12);
  EXPECT_NEAR(depthAlong(*face, -toward), 0.018, 1e-12);
  EXPECT_FALSE(faceBelow(finder, Vec3(0.008, 0.0, -0.022), Vec3::UnitX()));
}

TEST(FlatFace, BallsHaveNone) {
  EXPECT_FALSE(ContactFinder({makeTool({sphere(0.01)})}).hasFlatFaces(0));
  const std::string ball = writeStl("ball.stl", ballTriangles(12, 0.01));
  EXPECT_FALSE(ContactFinder({makeTool({mesh(ball)})}).hasFlatFaces(0));
}

// Where a mesh folds inwards, as in the notch of a fork, its face does not end.
TEST(FlatFace, FoldsInwardsAreNoEdges) {
  const double prong = 0.01, notch = 0.02;
  const ContactFinder finder(
      {makeTool({mesh(writeStl("fork.stl", forkTriangles(prong, notch, 0.02, 0.01)))})});
  // The notch's end, between the prongs, whose own ends are out of so short a reach: it ends at the
  // fork's sides alone.
  const double reach = 0.006;
  const auto in_notch = finder.flatFace(0, Pose::Identity(), kDown, Vec3(0.009, 0.0, 0.02), reach);
  ASSERT_TRUE(in_notch);
  EXPECT_NEAR(std::abs(in_notch->edges.front().outward.y()), 1.0, 1e-9);
  for (const Vec3& along : {Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitX())}) {
    EXPECT_TRUE(std::isnan(depthAlong(*in_notch, along)));
  }
  const auto on_prong = faceBelow(finder, Vec3(0.011, 0.0, 0.0));
  ASSERT_TRUE(on_prong);
  EXPECT_NEAR(depthAlong(*on_prong, -Vec3::UnitX()), 0.001, 1e-8);
}

TEST(FlatFace, TurnsWithItsLink) {
  const ContactFinder finder({makeTool({box(Vec3(0.02, 0.03, 0.01))})});
  const Pose pose = makePose(Vec3(0.1, 0.2, 0.3), 0.7, Vec3(1.0, 2.0, 3.0).normalized());
  const auto face =
      finder.flatFace(0, pose, pose.linear() * kDown, pose * Vec3(0.007, 0.001, -0.006), kReach);
  ASSERT_TRUE(face);
  EXPECT_NEAR((face->normal - pose.linear() * kDown).norm(), 0.0, 1e-12);
  EXPECT_NEAR(depthAlong(*face, pose.linear() * Vec3::UnitX()), 0.003, 1e-12);
}

}  // namespace
}  // namespace robot_tissue::test_flat_face
