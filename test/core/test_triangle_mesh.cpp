// Meshes as plain triangles: volume, welding, refinement.
#include <gtest/gtest.h>

#include <algorithm>

#include "mesh_fixtures.h"
#include "robot_tissue/core/mesh_checks.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue::test_triangle_mesh {
namespace {

double longestEdge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[at(a)];
    const Vec3& q = mesh.vertices[at(b)];
    const Vec3& r = mesh.vertices[at(c)];
    longest = std::max({longest, (p - q).norm(), (q - r).norm(), (r - p).norm()});
  }
  return longest;
}

double areaOf(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[at(b)] - mesh.vertices[at(a)])
                      .cross(mesh.vertices[at(c)] - mesh.vertices[at(a)])
                      .norm();
  }
  return area;
}

TEST(TriangleMesh, VolumeHasTheSignOfItsOrientation) {
  const TriangleMesh box = boxMesh(Vec3(10.0, 0.0, -1.0), Vec3(10.1, 0.2, -0.7));
  EXPECT_NEAR(volumeOf(box), 0.1 * 0.2 * 0.3, 1e-12);
  EXPECT_NEAR(volumeOf(insideOut(box)), -0.1 * 0.2 * 0.3, 1e-12);
  EXPECT_NEAR(volumeOf(sphereMesh(0.05, 5)), 4.0 / 3.0 * M_PI * 0.05 * 0.05 * 0.05, 1e-6);
  EXPECT_EQ(volumeOf({}), 0.0);
}

TEST(TriangleMesh, WeldingClosesATriangleSoup) {
  const TriangleMesh ball = sphereMesh(0.05, 3);
  const TriangleMesh loose = soup(ball);
  ASSERT_TRUE(meshFault(loose));
  const TriangleMesh mended = welded(loose);
  EXPECT_FALSE(meshFault(mended));
  EXPECT_EQ(mended.vertices.size(), ball.vertices.size());
  EXPECT_EQ(mended.triangles.size(), ball.triangles.size());
  EXPECT_NEAR(volumeOf(mended), volumeOf(ball), 1e-15);
}

TEST(TriangleMesh, WeldingJoinsRoundedCornersAndNoOthers) {
  Random random;
  TriangleMesh loose = soup(boxMesh(Vec3::Zero(), Vec3(0.1, 0.1, 0.1)));
  for (Vec3& vertex : loose.vertices) vertex += random.offset(2e-8);
  EXPECT_EQ(welded(loose).vertices.size(), 8U);
  TriangleMesh apart = soup(boxMesh(Vec3::Zero(), Vec3(0.1, 0.1, 0.1)));
  apart.vertices[0] += Vec3(1e-6, 0.0, 0.0);
  EXPECT_EQ(welded(apart).vertices.size(), 9U);
}

TEST(TriangleMesh, WeldingDropsCollapsedTrianglesAndSpareVertices) {
  TriangleMesh mesh = boxMesh(Vec3::Zero(), Vec3::Ones());
  mesh.vertices.emplace_back(0.5, 0.5, 0.5);
  mesh.triangles.push_back({0, 0, 1});
  const TriangleMesh clean = welded(mesh);
  EXPECT_EQ(clean.vertices.size(), 8U);
  EXPECT_EQ(clean.triangles.size(), 12U);
  EXPECT_TRUE(welded({}).triangles.empty());
}

TEST(TriangleMesh, RefinementBoundsTheEdgesAndKeepsTheShape) {
  const std::vector<TriangleMesh> meshes = {
      boxMesh(Vec3::Zero(), Vec3(0.1, 0.07, 0.002)), sphereMesh(0.05, 1),
      moved(boxMesh(Vec3::Zero(), Vec3(0.2, 0.001, 0.001)), Random().pose(1.0))};
  for (const TriangleMesh& mesh : meshes) {
    for (const double longest : {0.03, 0.005}) {
      const TriangleMesh fine = refined(mesh, longest);
      EXPECT_LE(longestEdge(fine), longest);
      EXPECT_GT(longestEdge(fine), 0.3 * longest);  // no finer than needed
      EXPECT_FALSE(meshFault(fine)) << *meshFault(fine);
      EXPECT_NEAR(volumeOf(fine) / volumeOf(mesh), 1.0, 1e-9);
      EXPECT_NEAR(areaOf(fine) / areaOf(mesh), 1.0, 1e-9);
      EXPECT_TRUE(std::equal(mesh.vertices.begin(), mesh.vertices.end(), fine.vertices.begin()));
    }
  }
}

TEST(TriangleMesh, FineMeshIsLeftAsItIs) {
  const TriangleMesh ball = sphereMesh(0.05, 2);
  EXPECT_EQ(refined(ball, 0.1).triangles, ball.triangles);
}

// A square face must be able to show a dent in its middle.
TEST(TriangleMesh, RefinementDoesNotMultiplyTriangles) {
  const TriangleMesh fine = refined(boxMesh(Vec3::Zero(), Vec3(0.1, 0.1, 0.1)), 0.005);
  // Right triangles with legs of 0.1 / 32 have hypotenuses of 0.0044.
  EXPECT_EQ(fine.triangles.size(), 12U * 32U * 32U);
}

TEST(TriangleMesh, EnclosesWhatItGoesAround) {
  const TriangleMesh ball = moved(sphereMesh(1.0, 3), Vec3(5.0, 0.0, 0.0));
  const TriangleMesh hollow =
      joined(ball, insideOut(moved(sphereMesh(0.5, 3), Vec3(5.0, 0.0, 0.0))));
  const auto inside = [](const TriangleMesh& mesh, double x) {
    return encloses(mesh.vertices, mesh.triangles, Vec3(x, 0.1, 0.1));
  };
  EXPECT_TRUE(inside(ball, 5.0));
  EXPECT_TRUE(inside(ball, 5.9));
  EXPECT_FALSE(inside(ball, 6.1));
  EXPECT_FALSE(inside(ball, -5.0));
  EXPECT_FALSE(inside(hollow, 5.0));
  EXPECT_TRUE(inside(hollow, 5.7));
}

}  // namespace
}  // namespace robot_tissue::test_triangle_mesh
