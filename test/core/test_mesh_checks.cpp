// Which meshes enclose tissue, and what is said of the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh_fixtures.h"
#include "robot_tissue/core/mesh_checks.h"

namespace robot_tissue::test_mesh_checks {
namespace {

std::string faultOf(const TriangleMesh& mesh) { return meshFault(mesh).value_or(""); }

TriangleMesh unitBox() { return boxMesh(Vec3::Zero(), Vec3::Ones()); }

void expectFault(const TriangleMesh& mesh, const std::string& words) {
  const std::string fault = faultOf(mesh);
  EXPECT_NE(fault.find(words), std::string::npos) << "'" << fault << "' has not: " << words;
  EXPECT_EQ(fault.find('\n'), std::string::npos);
}

TEST(MeshChecks, SoundMeshesHaveNoFault) {
  Random random;
  for (int trial = 0; trial < 20; ++trial) {
    EXPECT_EQ(faultOf(moved(unitBox(), random.pose(5.0))), "");
    EXPECT_EQ(faultOf(moved(sphereMesh(0.05, 3), random.pose(0.1))), "");
  }
  EXPECT_EQ(faultOf(insideOut(unitBox())), "");
  EXPECT_EQ(faultOf(joined(unitBox(), moved(unitBox(), Vec3(1.001, 0.0, 0.0)))), "");
  EXPECT_EQ(faultOf(boxMesh(Vec3::Zero(), Vec3(1.0, 1.0, 1e-4))), "");
}

TEST(MeshChecks, NoTrianglesOrNoNumbers) {
  expectFault({}, "has no triangles");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TriangleMesh mesh = unitBox();
    mesh.vertices[3].y() = bad;
    expectFault(mesh, "has a vertex that is not finite");
  }
}

TEST(MeshChecks, HoleIsCountedAndPlaced) {
  TriangleMesh mesh = unitBox();
  mesh.triangles.pop_back();  // of the top
  expectFault(mesh, "is not closed: 3 edges with one triangle or more than two, one of them at (");
  expectFault(mesh, ", 1) m");
}

TEST(MeshChecks, WallInsideIsNotClosed) {
  TriangleMesh mesh = unitBox();
  mesh.triangles.push_back({0, 1, 7});
  expectFault(mesh, "is not closed: 3 edges");
}

TEST(MeshChecks, TurnedTriangleIsCountedByItsEdges) {
  TriangleMesh mesh = unitBox();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  expectFault(mesh, "has 3 edges whose two triangles face opposite sides, one of them at (");
}

TEST(MeshChecks, FlatMeshesHaveNoVolume) {
  expectFault(boxMesh(Vec3::Zero(), Vec3(1.0, 1.0, 0.0)), "has no volume");
  expectFault(boxMesh(Vec3::Zero(), Vec3::Zero()), "has no volume");
  expectFault(boxMesh(Vec3::Zero(), Vec3(1.0, 1.0, 1e-10)), "has no volume");
  TriangleMesh two_sided;
  two_sided.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}};
  two_sided.triangles = {{0, 1, 2}, {0, 2, 1}};
  expectFault(two_sided, "has no volume");
}

TEST(MeshChecks, OverlappingShellsIntersect) {
  Random random;
  for (int trial = 0; trial < 20; ++trial) {
    const Pose pose = random.pose(1.0);
    const TriangleMesh overlapping = joined(unitBox(), moved(unitBox(), Vec3(0.9, 0.3, 0.2)));
    expectFault(moved(overlapping, pose), "intersects itself: ");
    const TriangleMesh balls =
        joined(sphereMesh(1.0, 2), moved(sphereMesh(1.0, 2), Vec3(1.9, 0, 0)));
    expectFault(moved(balls, pose), "intersects itself: ");
  }
}

TEST(MeshChecks, ShellsThatTouchIntersect) {
  expectFault(joined(unitBox(), moved(unitBox(), Vec3(1.0, 0.3, 0.2))), "intersects itself: ");
  // A corner on a face.
  TriangleMesh tip = sphereMesh(0.5, 0);
  EXPECT_EQ(faultOf(joined(unitBox(), moved(tip, Vec3(0.3, 0.4, 1.5001)))), "");
  expectFault(joined(unitBox(), moved(tip, Vec3(0.3, 0.4, 1.5))), "intersects itself: ");
}

// Neighbors, which share corners, are looked at too.
TEST(MeshChecks, VertexPulledThroughTheOppositeWallIntersects) {
  TriangleMesh ball = sphereMesh(1.0, 2);
  EXPECT_EQ(faultOf(ball), "");
  ball.vertices[0] = Vec3(-0.9, 0.1, 0.05);
  EXPECT_EQ(faultOf(ball), "");  // a deep dent
  ball.vertices[0] = Vec3(-1.2, 0.1, 0.05);
  expectFault(ball, "intersects itself: ");
}

// The vertex in the middle of the top is pushed in its plane: beyond the rim, triangles that share
// an edge or a corner lie on each other.
TEST(MeshChecks, FoldInAPlaneIntersects) {
  TriangleMesh mesh = refined(unitBox(), 0.8);
  const auto middle = std::find(mesh.vertices.begin(), mesh.vertices.end(), Vec3(0.5, 0.5, 1.0));
  ASSERT_NE(middle, mesh.vertices.end());
  *middle = Vec3(0.55, 0.52, 1.0);
  EXPECT_EQ(faultOf(mesh), "");
  *middle = Vec3(1.1, 0.55, 1.0);
  expectFault(mesh, "intersects itself: ");
}

// What the exact test finds is where two random triangles share a point: checked by minimizing
// their distance over many points.
TEST(MeshChecks, RandomTrianglesIntersectWhereTheirDistanceIsZero) {
  Random random;
  int intersecting = 0;
  for (int trial = 0; trial < 300; ++trial) {
    TriangleMesh two;
    for (int i = 0; i < 6; ++i) two.vertices.push_back(random.offset(1.0));
    two.triangles = {{0, 1, 2}, {3, 4, 5}};
    double nearest = 1e9;
    constexpr int kSteps = 24;
    std::array<std::vector<Vec3>, 2> points;
    for (std::size_t t = 0; t < 2; ++t) {
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; i + j <= kSteps; ++j) {
          const double u = i / double(kSteps);
          const double v = j / double(kSteps);
          points[t].push_back((1.0 - u - v) * two.vertices[3 * t] + u * two.vertices[3 * t + 1] +
                              v * two.vertices[3 * t + 2]);
        }
      }
    }
    for (const Vec3& p : points[0]) {
      for (const Vec3& q : points[1]) nearest = std::min(nearest, (p - q).squaredNorm());
    }
    const bool intersect = !intersectingTriangles(two).empty();
    intersecting += intersect ? 1 : 0;
    // Points stand at most 3.5 / 24 apart along an edge.
    if (intersect) {
      EXPECT_LT(std::sqrt(nearest), 0.15) << trial;
    } else {
      EXPECT_GT(std::sqrt(nearest), 1e-4) << trial;
    }
  }
  EXPECT_GT(intersecting, 20);
  EXPECT_LT(intersecting, 200);
}

TEST(MeshChecks, InsideOutMeshIsTurned) {
  const TriangleMesh ball = sphereMesh(0.05, 2);
  EXPECT_GT(volumeOf(facingOutward(ball)), 0.0);
  EXPECT_EQ(volumeOf(facingOutward(insideOut(ball))), volumeOf(ball));
}

TEST(MeshChecks, ShellsAreTurnedEachByItsPlace) {
  const TriangleMesh outer = sphereMesh(1.0, 2);
  const TriangleMesh cavity = sphereMesh(0.7, 2);
  const TriangleMesh core = moved(sphereMesh(0.3, 2), Vec3(0.1, 0.0, 0.2));
  const TriangleMesh beside = moved(sphereMesh(0.5, 2), Vec3(3.0, 0.0, 0.0));
  const double volume = volumeOf(outer) - volumeOf(cavity) + volumeOf(core) + volumeOf(beside);
  for (int turned = 0; turned < 16; ++turned) {
    const auto shell = [turned](const TriangleMesh& mesh, int bit) {
      return (turned >> bit & 1) != 0 ? insideOut(mesh) : mesh;
    };
    const TriangleMesh mesh =
        joined(joined(shell(outer, 0), shell(cavity, 1)), joined(shell(core, 2), shell(beside, 3)));
    ASSERT_EQ(faultOf(mesh), "");
    EXPECT_NEAR(volumeOf(facingOutward(mesh)), volume, 1e-9);
  }
}

}  // namespace
}  // namespace robot_tissue::test_mesh_checks
