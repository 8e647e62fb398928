// Flat faces of links: where their edges are from a point.
#include <gtest/gtest.h>

#include <algorithm>
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

ToolShape boxAt(const Vec3& center, const Vec3& size) {
  return placedAt(makePose(center), box(size));
}

// Points under, beside and over a face of 20 mm by 20 mm that looks down at z = 0.
std::vector<Vec3> pointsAround() {
  std::vector<Vec3> points;
  for (const double x : {-0.0115, -0.008, -0.0003, 0.003, 0.009, 0.0115}) {
    for (const double y : {-0.006, 0.0007, 0.008, 0.0118}) {
      for (const double z : {-0.0004, 0.0, 0.0005}) points.emplace_back(x, y, z);
    }
  }
  return points;
}

// The same edges on the same sides, wherever the face is looked at.
void expectFaceOf(const std::vector<ToolShape>& shapes, const ToolShape& whole, double reach) {
  const ContactFinder joined({makeTool(shapes)}), one({makeTool({whole})});
  for (const Vec3& point : pointsAround()) {
    const auto face = joined.flatFace(0, Pose::Identity(), kDown, point, reach);
    const auto of_one = one.flatFace(0, Pose::Identity(), kDown, point, reach);
    ASSERT_EQ(face.has_value(), of_one.has_value()) << point.transpose();
    if (!face) continue;
    EXPECT_NEAR(face->height_m, of_one->height_m, 1e-12);
    ASSERT_EQ(face->edges.size(), of_one->edges.size()) << point.transpose();
    for (const FaceEdge& edge : of_one->edges) {
      EXPECT_NEAR(depthAlong(*face, edge.outward), edge.depth_m, 1e-9) << point.transpose();
    }
  }
}

void expectFaceOfInAnyOrder(std::vector<ToolShape> shapes, const ToolShape& whole) {
  for (const double reach : {0.0125, 0.005}) {
    expectFaceOf(shapes, whole, reach);
    std::reverse(shapes.begin(), shapes.end());
    expectFaceOf(shapes, whole, reach);
  }
}

// Where shapes of a link are parts of one face, what is between them is no edge.
TEST(FlatFace, SeamsBetweenShapesAreNoEdges) {
  const Vec3 up(0.0, 0.0, 0.01);
  const ToolShape whole = boxAt(up, Vec3(0.02, 0.02, 0.02));
  const Vec3 half(0.01, 0.02, 0.02);
  const Vec3 aside(0.005, 0.0, 0.0);
  expectFaceOfInAnyOrder({boxAt(up - aside, half), boxAt(up + aside, half)}, whole);
  const Vec3 overlapping(0.014, 0.02, 0.02), less_aside(0.003, 0.0, 0.0);
  expectFaceOfInAnyOrder({boxAt(up - less_aside, overlapping), boxAt(up + less_aside, overlapping)},
                         whole);
  const Vec3 with_a_slot(0.00995, 0.02, 0.02), more_aside(0.005025, 0.0, 0.0);
  expectFaceOfInAnyOrder({boxAt(up - more_aside, with_a_slot), boxAt(up + more_aside, with_a_slot)},
                         whole);
  std::vector<ToolShape> tiles;
  for (const double x : {-0.0075, -0.0025, 0.0025, 0.0075}) {
    for (const double y : {-0.005, 0.005}) {
      tiles.push_back(boxAt(Vec3(x, y, 0.01), Vec3(0.005, 0.01, 0.02)));
    }
  }
  expectFaceOfInAnyOrder(tiles, whole);
}

TEST(FlatFace, AShapeInsideAnotherHasNoEdges) {
  const ToolShape whole = boxAt(Vec3(0.0, 0.0, 0.01), Vec3(0.02, 0.02, 0.02));
  for (const double short_of : {0.0, 1e-4}) {
    const Vec3 center(0.001, 0.002, 0.01 + short_of);
    expectFaceOfInAnyOrder({whole, boxAt(center, Vec3(0.008, 0.008, 0.02))}, whole);
  }
  // The legs of an L, with one bottom.
  const Vec3 sole(0.02, 0.02, 0.0005), leg(0.0005, 0.02, 0.02);
  const ToolShape bottom = boxAt(Vec3(0.0, 0.0, 0.00025), sole);
  expectFaceOfInAnyOrder({bottom, boxAt(Vec3(-0.00975, 0.0, 0.01), leg)}, bottom);
  const ToolShape disk = placedAt(makePose(Vec3(0.0, 0.0, 0.01)), cylinder(0.01, 0.02));
  expectFaceOfInAnyOrder({disk, boxAt(Vec3(0.0, 0.0, 0.01), Vec3(0.013, 0.013, 0.02))}, disk);
}

TEST(FlatFace, MeshesAreJoinedAsBoxesAre) {
  const auto half = [](const std::string& name, double x) {
    return mesh(writeStl(name, boxTriangles(Vec3(0.01, 0.02, 0.02), Vec3(x, 0.0, 0.01))));
  };
  const ContactFinder joined({makeTool({half("left.stl", -0.005), half("right.stl", 0.005)})});
  const auto face = joined.flatFace(0, Pose::Identity(), kDown, Vec3(0.002, 0.001, 0.0003), 0.0125);
  ASSERT_TRUE(face);
  EXPECT_NEAR(depthAlong(*face, Vec3::UnitX()), 0.008, 1e-8);
  EXPECT_NEAR(depthAlong(*face, -Vec3::UnitX()), 0.012, 1e-8);
  EXPECT_NEAR(depthAlong(*face, Vec3::UnitY()), 0.009, 1e-8);
  EXPECT_NEAR(depthAlong(*face, -Vec3::UnitY()), 0.011, 1e-8);
}

// A slot that is wide enough to be felt, and a shape that stands higher, end a face.
TEST(FlatFace, FacesApartKeepTheirEdges) {
  const Vec3 half(0.01, 0.02, 0.02);
  for (const Vec3& other : {Vec3(0.013, 0.0, 0.01), Vec3(0.005, 0.0, 0.013)}) {
    const ContactFinder apart(
        {makeTool({boxAt(Vec3(-0.005, 0.0, 0.01), half), boxAt(other, half)})});
    const auto face =
        apart.flatFace(0, Pose::Identity(), kDown, Vec3(-0.002, 0.001, 0.0003), 0.0125);
    ASSERT_TRUE(face);
    EXPECT_NEAR(depthAlong(*face, Vec3::UnitX()), 0.002, 1e-12);
    EXPECT_NEAR(depthAlong(*face, -Vec3::UnitX()), 0.008, 1e-12);
  }
}

// A mesh of a box, 20 mm wide, has the edges of one, whatever folds there are between.
void expectEdgesOfBox(const std::vector<Triangle>& triangles, const std::string& what) {
  const ContactFinder plain(
      {makeTool({mesh(writeStl("plain.stl", boxTriangles(Vec3::Constant(0.02))))})});
  const ContactFinder folded({makeTool({mesh(writeStl("folded.stl", triangles))})});
  const double reach = 0.0125;
  for (const double x : {0.0004, 0.004, -0.0075, 0.011}) {
    for (const double y : {0.0004, -0.006}) {
      const Vec3 point(x, y, -0.0101);
      const auto face = folded.flatFace(0, Pose::Identity(), kDown, point, reach);
      const auto expected = plain.flatFace(0, Pose::Identity(), kDown, point, reach);
      ASSERT_TRUE(face && expected) << what;
      ASSERT_EQ(face->edges.size(), expected->edges.size()) << what << " " << x << " " << y;
      for (const FaceEdge& edge : expected->edges) {
        EXPECT_NEAR(depthAlong(*face, edge.outward), edge.depth_m, 2e-6) << what << " " << x;
      }
    }
  }
}

// Vertices beside edges that they are not of, and fillers between, as CAD programs leave them.
TEST(FlatFace, SliversOfAMeshAreNoEdges) {
  for (const double height : {0.0, 1e-7, 1e-6, -1e-6}) {
    std::vector<Triangle> triangles = boxTriangles(Vec3::Constant(0.02));
    const Triangle lower = triangles[1], side = triangles[4];  // of the bottom, and beside it
    const Vec3 middle = 0.5 * (lower[0] + lower[1]) + height * Vec3::UnitZ();
    triangles[1] = {{lower[0], middle, lower[2]}};
    triangles.push_back({{middle, lower[1], lower[2]}});
    triangles.push_back({{lower[0], lower[1], middle}});
    const Vec3 at_rim = 0.4 * side[0] + 0.6 * side[1] + height * Vec3::UnitY();
    triangles[4] = {{side[0], at_rim, side[2]}};
    triangles.push_back({{at_rim, side[1], side[2]}});
    triangles.push_back({{side[0], side[1], at_rim}});
    expectEdgesOfBox(triangles, "height " + std::to_string(1e6 * height) + " um");
  }
}

TEST(FlatFace, FoldsThatAreNotFeltAreNoEdges) {
  for (const double deep : {1e-5, 1e-4, 5e-4}) {
    const double half = 0.00025, low = -0.01, high = 0.01;
    const std::vector<Eigen::Vector2d> outline = {
        {low, low},  {-half, low}, {-half, low + deep}, {half, low + deep},
        {half, low}, {high, low},  {high, high},        {low, high}};
    const auto grooved = prismTriangles(
        outline, {{0, 1, 2}, {0, 2, 7}, {2, 3, 6}, {2, 6, 7}, {3, 4, 5}, {3, 5, 6}}, 0.02);
    expectEdgesOfBox(grooved, "groove of " + std::to_string(1e6 * deep) + " um");
  }
}

}  // namespace
}  // namespace robot_tissue::test_flat_face
